#include "apps/halflit/golden/check.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "apps/io/platform/paths.hpp"
#include "halflit/image.hpp"
#include "halflit/target.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <new>

namespace halflit::cli {
namespace {

namespace fs = std::filesystem;

struct DrawnScene {
    Image image;
    bool framed = false;
    std::optional<KeptView> view;  ///< of a framed picture; only with CameraUse::record
};

enum class CameraUse : std::uint8_t {
    as_recorded,  ///< without a record: framed
    record,       ///< the same; those that are framed are also returned
    reframe       ///< the same, whatever is recorded
};

/// Draws by the camera that another run reads from the list. It may differ from that of the framing in the last bits.
Result<void> keep_view(RenderJob& job, RenderOptions& options) {
    options.kept_view = kept_view(job.camera, job.film.bounds, job.settings, job.source.placement);
    return change_job(job, options, false);
}

Result<DrawnScene> draw(const GoldenList& list, const GoldenScene& scene, CameraUse cameras) {
    auto options = golden_options(list, scene);
    if (!options) return tl::unexpected(options.error());
    if (cameras == CameraUse::reframe) options->kept_view.reset();
    auto job = make_render_job(*options);
    if (!job) return tl::unexpected(job.error());
    DrawnScene drawn;
    drawn.framed = job->film.framed;
    if (drawn.framed && cameras != CameraUse::as_recorded) {
        if (!options->kept_view)
            if (const auto kept = keep_view(*job, *options); !kept) return tl::unexpected(kept.error());
        drawn.view = options->kept_view;
    }
    Image& image = drawn.image = make_image(*job, false);
    const auto rendered =
        Renderer().render(*job->prepared, job->light, job->camera, job->settings, target_of(*job, image), job->timed_execution());
    if (!rendered) return tl::unexpected(rendered.error());
    for (const auto& warnings : {job->warnings, rendered->warnings})
        for (const std::string& warning : warnings) print_warning(scene.name + ": " + warning);
    return drawn;
}

/// A scene that is too large fails alone; the others are still drawn.
Result<DrawnScene> draw_within_memory(const GoldenList& list, const GoldenScene& scene, CameraUse cameras) {
    try {
        return draw(list, scene, cameras);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "out of memory");
    }
}

void set_failed(GoldenResult& result, const Error& error) {
    result.status = DiffStatus::failed;
    result.message = error.message;
    result.error = error.code;
}

/// Compares with the expected picture, and writes the report's pictures.
Result<void> compare(const GoldenList& list, const Image& actual, const GoldenCheck& options, GoldenResult& result) {
    const std::string& name = result.path;
    const auto in_report = [&](const std::string& file) { return path_in(options.report_folder, file); };
    result.actual_picture = name + "-actual.png";
    if (const auto written = write_image(in_report(result.actual_picture), actual); !written) return written;
    if (result.expected_hash.empty()) {
        result.status = DiffStatus::missing;
        result.message = "no expected picture; halflit golden update makes it";
        return {};
    }
    const auto expected = io::read_picture(list.picture(name));
    if (!expected) {
        set_failed(result, expected.error());
        return {};
    }
    result.expected_picture = name + "-expected.png";
    if (const auto written = write_image(in_report(result.expected_picture), *expected); !written) return written;
    const std::string difference = name + "-difference.png";
    const auto diff = diff_images(*expected, actual, result.tolerance, name, in_report(difference));
    if (!diff) return tl::unexpected(diff.error());
    static_cast<DiffedFile&>(result) = *diff;
    if (diff->diff && diff->diff->count > 0) result.difference_picture = difference;
    if (const std::string found = hash_text(expected->rgba8); found != result.expected_hash) {
        result.status = DiffStatus::differs;
        result.message = fmt::format("{}.png has the hash {}, expected {} as in hashes.txt; halflit golden update renews both", name, found,
                                     result.expected_hash);
    }
    return {};
}

}  // namespace

Result<std::vector<GoldenResult>> check_golden(const GoldenList& list, const std::vector<const GoldenScene*>& scenes,
                                               const GoldenCheck& options) {
    // Pictures of an earlier check would contradict this one's page.
    for (const GoldenScene& scene : list.scenes)
        for (const char* kind : {"-expected.png", "-actual.png", "-difference.png"}) {
            std::error_code ignored;
            fs::remove(platform::to_path(path_in(options.report_folder, scene.name + kind)), ignored);
        }
    std::vector<GoldenResult> results;
    for (const GoldenScene* scene : scenes) {
        const Stopwatch watch;
        GoldenResult result;
        result.path = scene->name;
        result.scene = scene;
        result.expected_hash = list.hash(scene->name);
        result.tolerance = {options.max_codes.value_or(scene->max_codes.value_or(0)),
                            options.max_share.value_or(scene->max_share.value_or(0.0))};
        const auto actual = draw_within_memory(list, *scene, CameraUse::as_recorded);
        if (actual) {
            result.hash = hash_text(actual->image.rgba8);
            result.framed = actual->framed;
            result.kept = actual->framed && list.camera(*scene) != nullptr;
        } else {
            set_failed(result, actual.error());
        }
        if (actual && result.hash != result.expected_hash)
            if (const auto compared = compare(list, actual->image, options, result); !compared) return tl::unexpected(compared.error());
        result.ms = watch.ms();
        results.push_back(std::move(result));
    }
    return results;
}

std::vector<GoldenResult> update_golden(GoldenList& list, const std::vector<const GoldenScene*>& scenes, bool reframe) {
    std::vector<GoldenResult> results;
    for (const GoldenScene* scene : scenes) {
        const Stopwatch watch;
        const std::string path = list.picture(scene->name);
        GoldenResult result;
        result.path = scene->name;
        result.scene = scene;
        result.expected_hash = list.hash(scene->name);
        const auto update = [&]() -> Result<void> {
            const auto drawn = draw_within_memory(list, *scene, reframe ? CameraUse::reframe : CameraUse::record);
            if (!drawn) return tl::unexpected(drawn.error());
            const Image& actual = drawn->image;
            result.hash = hash_text(actual.rgba8);
            result.framed = drawn->framed;
            result.kept = drawn->framed && !reframe && list.camera(*scene) != nullptr;
            const auto record = [&] {
                if (drawn->view)
                    list.cameras[scene->name] = {flags_hash(*scene), *drawn->view};
                else
                    list.cameras.erase(scene->name);
            };
            std::error_code ignored;
            const bool exists = fs::exists(platform::to_path(path), ignored);
            const auto before = exists ? io::read_picture(path) : fail(ErrorCode::io, "");
            const bool same = before && hash_text(before->rgba8) == result.hash;
            if (same && result.hash == result.expected_hash) {
                record();
                return {};
            }
            if (exists && !same && result.expected_hash.empty())
                return fail(ErrorCode::io, printable(path) + ": exists, is not in hashes.txt and is not overwritten");
            if (before) {
                const auto diff = diff_images(*before, actual, {}, scene->name, "");
                if (!diff) return tl::unexpected(diff.error());
                static_cast<DiffedFile&>(result) = *diff;
            }
            if (!same)
                if (const auto written = write_image(path, actual); !written) return written;
            if (result.expected_hash.empty() || !exists) result.status = DiffStatus::missing;
            list.hashes[scene->name] = result.hash;
            record();
            return {};
        };
        if (const auto updated = update(); !updated) set_failed(result, updated.error());
        result.ms = watch.ms();
        results.push_back(std::move(result));
    }
    return results;
}

}  // namespace halflit::cli
