#include "apps/web/picture_session.hpp"

#include "apps/engine/request/render_options.hpp"
#include "apps/engine/trade/trade_error.hpp"
#include "apps/web/session_report.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace halflit::web {
namespace {

/// Flags that change neither what is loaded nor how it is lit.
constexpr std::string_view kSettingsFlags[] = {"--camera",
                                               "--camera-position",
                                               "--camera-target",
                                               "--fov",
                                               "--azimuth",
                                               "--elevation",
                                               "--zoom",
                                               "--lobe",
                                               "--wrap",
                                               "--power",
                                               "--normalize",
                                               "--specular",
                                               "--samples",
                                               "--point-size",
                                               "--line-width",
                                               "--shading",
                                               "--shadows",
                                               "--sky-shadows",
                                               "--contact-shadow",
                                               "--specular-normalize",
                                               "--sh-order",
                                               "--tonemap",
                                               "--max-error",
                                               "--accuracy",
                                               "--shadow-fade",
                                               "--soft-shadow-maps",
                                               "--shadow-terminator",
                                               "--texture-filter",
                                               "--anisotropy",
                                               "--line-width",
                                               "--shadow-memory",
                                               "--normal-scale",
                                               "--view",
                                               "--fit",
                                               "--ortho",
                                               "--orthographic",
                                               "--camera-orbit",
                                               "--edge-color"};
/// Flags that change how it is lit, or the picture's size, by which the maps of its shadows are chosen. For all others the scene is loaded
/// anew.
constexpr std::string_view kLightFlags[] = {"--light",      "--no-scene-lights", "--ambient",  "--env",
                                            "--env-rotate", "--env-sun",         "--sun-size", "--lamp-size",
                                            "--exposure",   "--background",      "--size",     "--shadow-size"};

bool is_one_of(std::string_view flag, std::span<const std::string_view> flags) {
    return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

/// The flags that load the scene, and those that light it, each with its value.
struct Keys {
    std::string scene, light;
};

Keys keys_of(const std::string& scene, const std::vector<std::string>& flags) {
    Keys keys{scene, ""};
    std::string* key = nullptr;
    for (const std::string& word : flags) {
        if (word.starts_with("--"))
            key = is_one_of(word, kSettingsFlags) ? nullptr : is_one_of(word, kLightFlags) ? &keys.light : &keys.scene;
        if (key != nullptr) key->append("\n").append(word);
    }
    return keys;
}

}  // namespace

void PictureSession::forget_scene() { job_.reset(); }

Result<void> PictureSession::apply(const std::string& scene, const std::vector<std::string>& flags) {
    const engine::Stopwatch watch;
    auto options = engine::parse_render_flags(flags);
    if (!options) return tl::unexpected(options.error());
    if (options->film.views.size() > 1) return fail(ErrorCode::usage, "--view: one side for each picture");
    options->scene = scene;
    options->execution.threads = 1;
    options->may_want_reference = true;
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;  // of the 2 GB that the module may take
    std::uint64_t& most = options->load.limits.max_geometry_bytes;
    most = std::min(most, kMostBytes);
    Keys keys = keys_of(scene, flags);
    if (job_ && keys.scene == scene_flags_) {
        const bool same_light = keys.light == light_flags_;
        light_flags_ = "?";  // until it is done
        if (const auto changed = engine::change_job(*job_, *options, kUsualSize, same_light); !changed) {
            job_.reset();
            return changed;
        }
    } else {
        job_.reset();  // its memory first
        auto job = engine::make_render_job(*options, kUsualSize);
        if (!job) return tl::unexpected(job.error());
        job_.emplace(std::move(*job));
        scene_flags_ = std::move(keys.scene);
    }
    light_flags_ = std::move(keys.light);
    job_->execution.time_limit_s = options->timeout_s;  // of this picture, beside what the loading took
    apply_ms_ += watch.ms();
    return {};
}

Result<Image> PictureSession::render(const Settings& settings, bool linear) {
    Image image = engine::make_image(*job_, linear);
    auto report = renderer_.render(*job_->prepared, job_->light, job_->camera, settings, engine::target_of(*job_, image), job_->execution);
    if (!report) return tl::unexpected(report.error());
    last_ = std::move(*report);
    return image;
}

Result<void> PictureSession::draw(const std::string& scene, const std::vector<std::string>& flags) {
    if (const auto applied = apply(scene, flags); !applied) return applied;
    auto image = render(job_->settings, false);
    if (!image) return tl::unexpected(image.error());
    picture_ = std::move(*image);
    picture_apply_ms_ = std::exchange(apply_ms_, 0.0);
    comparison_.clear();
    return {};
}

std::string PictureSession::report() const {
    if (!comparison_.empty()) return comparison_;
    return job_ ? picture_report(*job_, last_, picture_, picture_apply_ms_) : "{}";
}

Result<void> PictureSession::compare(const std::string& scene, const std::vector<std::string>& flags) {
    if (const auto applied = apply(scene, flags); !applied) return applied;
    const auto drawn = render(job_->settings, true);
    if (!drawn) return tl::unexpected(drawn.error());
    Settings settings = job_->settings;
    settings.shading.max_error_codes = 0.0;
    settings.shading.environment_bands = 0;
    settings.background_linear = {0, 0, 0, 0};
    settings.background_environment = false;
    settings.contact_shadow = 0.0f;
    const auto coverage = render(settings, true);
    if (!coverage) return tl::unexpected(coverage.error());
    settings = job_->settings;
    settings.shading.max_error_codes = 0.0;
    settings.shading.environment_bands = 0;
    settings.shading.accuracy = Accuracy::reference;
    const engine::Stopwatch watch;
    const auto truth = render(settings, true);
    if (!truth) return tl::unexpected(truth.error());
    const double reference_ms = watch.ms();
    const engine::TradeReference reference(*truth, *coverage, job_->settings.tone_curve);
    const engine::TradeError error = reference.error_of(*drawn);
    const double gain = 255.0 / std::max(error.max, 1e-6);
    picture_ = reference.difference(*drawn, gain);
    comparison_ = error_report(error, reference_ms);
    return {};
}

}  // namespace halflit::web
