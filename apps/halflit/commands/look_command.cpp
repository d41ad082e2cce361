// halflit look: labelled views of a model on one sheet, and a report of what they show.
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/look/certificate.hpp"
#include "apps/halflit/look/look_json.hpp"
#include "apps/halflit/look/look_sheet.hpp"
#include "apps/halflit/look/part_views.hpp"
#include "apps/halflit/program/file_names.hpp"
#include "apps/halflit/program/heap.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/halflit/program/timeout.hpp"
#include "apps/halflit/report/measures_json.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>

namespace halflit::cli {
namespace {

constexpr PictureSize kViewSize{480, 400}, kCertifiedSize{800, 640};
constexpr PictureSize kMargin{76, 44};  // pixels: room for dimension lines
constexpr std::size_t kMostAlone = 24;  // parts that are drawn alone
constexpr const char* kPaper = "#eceef1";

struct LookOptions : RenderOptions {
    std::string output, json;
    Projection projection = Projection::third_angle;
    bool perspective = false;
    int certify = 0;  ///< pixels that count as seen; 0: no certificate
    int most_views = 24;
};

/// Pictures are larger where each triangle has to be seen.
PictureSize usual_size(const LookOptions& options) { return options.certify > 0 ? kCertifiedSize : kViewSize; }

/// What a sheet of views has unless the flags say otherwise.
void set_defaults(LookOptions& options) {
    const auto given = [&](std::string_view name) {
        return std::find(options.given_settings.begin(), options.given_settings.end(), name) != options.given_settings.end();
    };
    if (!given("edges")) options.settings.edges = EdgeChoice::feature;
    if (options.settings.background_linear == usual_settings().background_linear)
        if (const auto paper = parse_color(kPaper)) options.settings.background_linear = *paper;
    options.view.orthographic = !options.perspective;
    if (options.camera || options.camera_position || (options.whole_scene && options.film.views.empty())) return;  // one view
    if (options.film.views.empty()) options.film.views = *parse_views("front,right,top,iso");
    options.whole_scene = true;
    if (!options.fit_px) {
        const PictureSize size = options.size.value_or(usual_size(options));
        options.fit_px = PictureSize{std::min(kMargin.width, size.width / 5), std::min(kMargin.height, size.height / 5)};
    }
}

/// Adds pictures to the shots until each triangle is seen.
Result<Certificate> add_views(RenderJob& job, Renderer& renderer, Renderer& alone, const LookOptions& options,
                              std::vector<ViewShot>& shots) {
    auto certificate = certify(job, alone, shots, {options.certify, static_cast<std::size_t>(options.most_views)});
    if (!certificate) return certificate;
    for (std::size_t i = shots.size(); i < certificate->shots.size(); ++i) {
        auto shot = draw_shot(job, renderer, certificate->shots[i].name, certificate->shots[i].camera, {});
        if (!shot) return tl::unexpected(shot.error());
        shot->detail = certificate->shots[i].detail;
        shots.push_back(std::move(*shot));
    }
    return certificate;
}

Result<int> look(const LookOptions& options) {
    auto made = make_render_job(options, usual_size(options));
    if (!made) return tl::unexpected(made.error());
    RenderJob& job = *made;
    for (const std::string& warning : job.warnings) print_warning(warning);
    Renderer renderer;
    std::vector<ViewShot> shots;
    const std::size_t views = std::max<std::size_t>(options.film.views.size(), 1);
    for (std::size_t i = 0; i < views; ++i) {
        const bool own = options.film.views.empty();
        auto shot = draw_shot(job, renderer, own ? "view" : options.film.views[i].name, own ? job.camera : job.film.views[i], {});
        if (!shot) return tl::unexpected(shot.error());
        shots.push_back(std::move(*shot));
    }
    Renderer alone;  // keeps what the pictures' renderer has
    std::optional<Certificate> certificate;
    if (options.certify > 0) {
        auto certified = add_views(job, renderer, alone, options, shots);
        if (!certified) return tl::unexpected(certified.error());
        certificate = std::move(*certified);
    }
    const auto contents = count_parts(job, alone, shots, kMostAlone);
    if (!contents) return tl::unexpected(contents.error());
    const auto measures = measures_json(job);
    if (!measures) return tl::unexpected(measures.error());
    Json report = look_json(job, *measures, shots, *contents);
    if (certificate) report["certificate"] = certificate_json(job, *certificate);
    if (!options.output.empty()) {
        const auto format = output_format_of(options.output);
        if (!format) return tl::unexpected(format.error());
        const auto sheet = look_sheet(job, shots, *contents, options.projection, look_footer(job, *measures));
        if (!sheet) return tl::unexpected(sheet.error());
        const auto bytes = encode_image(*sheet, *format);
        if (!bytes) return tl::unexpected(bytes.error());
        if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
        if (options.output != "-") print_note(fmt::format("wrote {}, {}x{}", options.output, sheet->width, sheet->height));
    }
    if (!options.json.empty())
        if (const auto written = write_text(options.json, to_text(report)); !written) return tl::unexpected(written.error());
    for (std::size_t i = 0; i < shots.size(); ++i)
        for (const std::string& fault : (*contents)[i].faults.names()) print_warning(fmt::format("view {}: {}", shots[i].name, fault));
    for (const Json& number : report["never_seen"]) {
        const Part& part = job.source.parts->list()[number.get<std::size_t>() - 1];
        print_warning(fmt::format("part {}{}{} is in no view", number.get<std::size_t>(), part.name.empty() ? "" : ", ", part.name));
    }
    if (certificate) {
        const auto of = [&](TriangleStatus status) { return certificate->count(status); };
        print_note(
            fmt::format("certificate: {} triangles seen with {} pixels or more in {} views, {} hidden, {} seen with less, {} unknown",
                        of(TriangleStatus::seen), options.certify, shots.size(), of(TriangleStatus::hidden), of(TriangleStatus::less),
                        of(TriangleStatus::unknown)));
    }
    return report["good"] == true && (!certificate || certificate->complete()) ? 0 : 1;
}

Result<int> run_look(LookOptions options) {
    if (options.film.turntable > 0 || options.film.frames) return fail(ErrorCode::usage, "look: expected views, found moving pictures");
    if (options.settings.region.width > 0) return fail(ErrorCode::usage, "--region: expected whole pictures in a sheet");
    if (options.output.empty() && options.json.empty()) {
        const std::string stem = stem_of(options.scene);
        options.output = (options.scene == "-" || stem.empty() ? "halflit" : stem.substr(0, stem.find(':'))) + ".look.png";
    }
    if (options.output == "-" && options.json == "-") return fail(ErrorCode::usage, "--json -: cannot be combined with -o -");
    for (const std::string& path : {options.output, options.json}) {
        if (path.empty() || path == "-") continue;
        if (same_file(path, options.scene)) return fail(ErrorCode::io, path + ": is the scene itself and is not overwritten");
        if (const auto checked = check_writable(path); !checked) return tl::unexpected(checked.error());
    }
    if (options.max_memory_bytes == 0) prepare_heap();
    set_defaults(options);
    return within_time(options.timeout_s, [&] { return look(options); });
}

}  // namespace

Command look_command() {
    const auto options = std::make_shared<LookOptions>();
    LookOptions& o = *options;
    auto groups = render_flags(o, kViewSize);
    groups.insert(
        groups.begin(),
        {"Sheet",
         {{"-o,--output", "FILE",
           "The sheet: a .png, .jpg, .bmp, .tga or .webp file; - for PNG on standard output (default: SCENE's name.look.png)",
           read_text(o.output)},
          {"--json", "FILE|-", "Cameras, and what each view shows of each part, as JSON; without -o, no sheet is drawn", read_text(o.json)},
          {"--projection", "third|first", "Third angle: the top is above the front; first angle: below it (default third)",
           [&o](const std::string& text) -> Result<void> {
               if (text != "third" && text != "first") return fail(ErrorCode::usage, "expected third or first, found '" + text + "'");
               o.projection = text == "first" ? Projection::first_angle : Projection::third_angle;
               return {};
           }},
          {"--certify", "PIXELS",
           "Add views until each triangle is seen with so many pixels, or is hidden from all around; the report lists those that are not",
           read_int(o.certify, 1, 10000)},
          {"--certify-views", "N", fmt::format("Most views of a certificate (default {})", o.most_views), read_int(o.most_views, 1, 1000)},
          {"--perspective", "", "Draw views in perspective; without it, by parallel rays", set_to(o.perspective)}}});
    return {"look",
            "Draw labelled views of a model on one sheet, and report what they show",
            {scene_argument(o, true)},
            std::move(groups),
            [options] { return run_look(*options); }};
}

}  // namespace halflit::cli
