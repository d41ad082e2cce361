#include "apps/engine/look/look.hpp"

#include "apps/engine/answers/measures_json.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/printable.hpp"
#include "apps/engine/look/certificate.hpp"
#include "apps/engine/look/look_json.hpp"
#include "apps/engine/look/part_views.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "sh/time_limit.hpp"

#include "apps/io/files/in_parts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

constexpr PictureSize kCertifiedSize{800, 640};
constexpr PictureSize kMargin{76, 44};  // pixels: room for dimension lines
constexpr int kMostSectionViews = 4;
constexpr std::size_t kMostAlone = 24;  // parts that are drawn alone
constexpr const char* kPaper = "#eceef1";

/// Defaults of a sheet of views, which flags may change.
void set_defaults(LookOptions& options) {
    if (options.certify > 0) options.usual_size = kCertifiedSize;                   // where each triangle has to be seen
    if (!options.has_given("shadows")) options.settings.shadows = ShadowMode::off;  // their borders look like edges
    if (!options.has_given("edges")) options.settings.edges = EdgeChoice::feature;
    if (!options.background_linear)
        if (const auto paper = parse_color(kPaper)) options.background_linear = *paper;
    options.view.orthographic = !options.perspective;
    if (options.camera || options.camera_position || (options.whole_scene && options.film.views.empty())) return;  // one view
    if (options.film.views.empty()) {
        options.film.views = usual_views();
        // The sides may all show a cut from behind.
        for (int i = 0; !options.projection && i < std::min(static_cast<int>(options.sections.size()), kMostSectionViews); ++i)
            options.film.views.push_back({.name = i == 0 ? "section" : fmt::format("section {}", i + 1),
                                          .facing = options.sections[static_cast<std::size_t>(i)].normal});
    }
    options.whole_scene = true;
    if (!options.fit_px) {
        const PictureSize size = options.picture_size();
        options.fit_px = PictureSize{std::min(kMargin.width, size.width / 5), std::min(kMargin.height, size.height / 5)};
    }
}

/// The views that the flags name; one of the file's camera or the flags' otherwise.
Result<std::vector<ViewShot>> draw_views(RenderJob& job, Renderer& renderer, const LookOptions& options, const ShotPlanes& planes) {
    std::vector<ViewShot> shots;
    const bool own = job.film.views.empty();
    for (std::size_t i = 0; i < std::max<std::size_t>(job.film.views.size(), 1); ++i) {
        auto shot = draw_shot(job, renderer, own ? "view" : options.film.views[i].name, own ? job.camera : job.film.views[i], planes);
        if (!shot) return tl::unexpected(shot.error());
        shots.push_back(std::move(*shot));
    }
    return shots;
}

std::vector<std::string> faults_of(const RenderJob& job, std::span<const ViewShot> shots, std::span<const ViewContent> contents,
                                   const Json& report) {
    std::vector<std::string> faults;
    for (std::size_t i = 0; i < shots.size(); ++i)
        for (const std::string& fault : contents[i].faults.names()) faults.push_back(fmt::format("view {}: {}", shots[i].name, fault));
    constexpr std::size_t kMostNamed = 5;
    const Json& unseen = report["never_seen"];
    if (unseen.size() > kMostNamed) {
        faults.push_back(fmt::format("{} parts of {} are in no view", unseen.size(), job.source.parts->list().size()));
        return faults;
    }
    for (const Json& number : unseen) {
        const Part& part = job.source.parts->list()[number.get<std::size_t>() - 1];
        faults.push_back(fmt::format("part {}{}{} is in no view", number.get<std::size_t>(), part.name.empty() ? "" : ", ", part.name));
    }
    return faults;
}

/// The file of a view in the folder.
Result<std::string> view_path(const std::string& folder, const std::string& view, std::size_t index) {
    auto name = fill_pattern("{view:02}_{view}.png", "{view} or {view:02}", [&](std::string_view word) -> std::optional<std::string> {
        if (word != "view") return digits_for(word, "view", static_cast<std::int64_t>(index) + 1);
        std::string text = view;
        std::replace(text.begin(), text.end(), ' ', '_');
        return text;
    });
    if (!name) return name;
    return path_in(folder, *name);
}

/// Writes the pictures' files into the report too.
Result<std::vector<ViewPicture>> view_pictures(const std::string& folder, const RenderJob& job, std::span<const ViewShot> shots,
                                               std::span<const ViewContent> contents, Json& report) {
    std::vector<ViewPicture> pictures;
    for (std::size_t i = 0; i < shots.size(); ++i) {
        auto path = view_path(folder, shots[i].name, i);
        if (!path) return tl::unexpected(path.error());
        report["views"][i]["file"] = *path;
        pictures.push_back({std::move(*path), marked_view(job, shots[i], contents[i])});
    }
    return pictures;
}

std::string certificate_line(const Certificate& certificate, std::size_t views) {
    const auto of = [&](TriangleStatus status) { return certificate.count(status); };
    return fmt::format("certificate: {} triangles seen with {} pixels or more in {} views, {} hidden, {} seen with less, {} unknown",
                       of(TriangleStatus::seen), certificate.least, views, of(TriangleStatus::hidden), of(TriangleStatus::less),
                       of(TriangleStatus::unknown));
}

}  // namespace

std::vector<FlagGroup> look_flags(LookOptions& o) {
    auto groups = render_flags(o, kViewSize);
    tell_default(groups, "--edges", "none", "feature");
    tell_default(groups, "--shadows", "soft-split", "off");
    groups.insert(
        groups.begin(),
        {"Sheet",
         {{"--projection", "third|first",
           "Arrangement of views of sides, with the front among them: third angle: the top is above the front, the right side on its "
           "right; first angle: the other way round (default third)",
           [&o](const std::string& text) -> Result<void> {
               if (text != "third" && text != "first") return fail(ErrorCode::usage, "expected third or first, found '" + text + "'");
               o.projection = text == "first" ? Projection::first_angle : Projection::third_angle;
               return {};
           }},
          {"--certify", "PIXELS",
           "Add views until every triangle is seen; PIXELS: how many pixels of it one view must show. Triangles that are hidden from all "
           "around are left out; the report lists those that are missing",
           read_int(o.certify, 1, 10000)},
          {"--certify-views", "N", fmt::format("Largest number of views that --certify draws (default {})", o.most_views),
           read_int(o.most_views, 1, 1000)},
          {"--perspective", "", "Draw views in perspective; without it, by parallel rays", set_to(o.perspective)}}});
    return groups;
}

Result<RenderJob> look_job(LookOptions& options) {
    if (options.film.turntable > 0 || options.film.frames) return fail(ErrorCode::usage, "look: expected views, found moving pictures");
    if (options.settings.region.width > 0) return fail(ErrorCode::usage, "--region: expected whole pictures in a sheet");
    if (const auto settled = settle_cameras(options); !settled) return tl::unexpected(settled.error());
    set_defaults(options);
    if (options.projection) {
        std::vector<std::string> names;
        for (const GivenView& view : options.film.views) names.push_back(view.name);
        if (!make_drawing(names))
            return fail(ErrorCode::usage,
                        "--projection: expected views of a drawing: front, and others of right, left, top, bottom, back and iso; "
                        "found " +
                            (names.empty() ? std::string("one camera") : joined(names, ", ")));
    }
    return make_measured_job(options);
}

Result<LookResult> look(const LookOptions& given) {
    LookOptions options = given;
    auto made = look_job(options);
    if (!made) return tl::unexpected(made.error());
    RenderJob& job = *made;
    Renderer renderer;
    const ShotPlanes planes{.picture = options.sheet || !options.folder.empty()};
    Result<std::vector<ViewShot>> views;
    std::optional<Certificate> certificate;
    const auto draw = [&]() -> Result<void> {
        views = draw_views(job, renderer, options, planes);
        if (!views || options.certify == 0) return {};
        // Views are added until each triangle is seen.
        auto certified = certify(job, renderer, std::move(*views), {options.certify, static_cast<std::size_t>(options.most_views), planes});
        if (!certified) return tl::unexpected(certified.error());
        certificate = std::move(*certified);
        views = std::move(certificate->shots);
        return {};
    };
    // The scene is measured while it is drawn.
    Result<Json> measures;
    Result<void> drawn;
    io::detail::in_parts(2, io::detail::parts_of(2, 1, options.execution.threads), [&](std::size_t, std::size_t begin, std::size_t end) {
        if (begin == 0) drawn = draw();
        if (end == 2) measures = measures_json(job);
    });
    if (!drawn) return tl::unexpected(drawn.error());
    if (!views) return tl::unexpected(views.error());
    if (!measures) return tl::unexpected(measures.error());
    const std::vector<ViewShot>& shots = *views;
    Renderer alone;  // keeps what the pictures' renderer has
    const auto contents = count_parts(job, alone, shots, kMostAlone);
    if (!contents) return tl::unexpected(contents.error());
    LookResult result;
    result.warnings = job.warnings;
    result.report = look_json(job, *measures, shots, *contents);
    if (!job.sections.cuts.empty()) result.report["sections"] = sections_json(job);
    if (certificate) {
        result.report["certificate"] = certificate_json(job, *certificate);
        result.certificate = certificate_line(*certificate, shots.size());
    }
    if (options.sheet) {
        std::vector<VectorShape> shapes;
        auto sheet = look_sheet(job, shots, *contents, options.projection.value_or(Projection::third_angle), look_footer(job, *measures),
                                options.vectors == VectorFormat::none ? nullptr : &shapes);
        if (!sheet) return tl::unexpected(sheet.error());
        if (options.vectors != VectorFormat::none) result.drawing = vector_file(options.vectors, shapes, sheet->width, sheet->height);
        result.sheet = std::move(*sheet);
    }
    if (!options.folder.empty()) {
        auto pictures = view_pictures(options.folder, job, shots, *contents, result.report);
        if (!pictures) return tl::unexpected(pictures.error());
        result.pictures = std::move(*pictures);
    }
    if (job.source.file) result.inputs = job.source.file->files;
    result.faults = faults_of(job, shots, *contents, result.report);
    result.good = result.report["good"] == true && (!certificate || certificate->complete());
    return result;
}

}  // namespace halflit::engine
