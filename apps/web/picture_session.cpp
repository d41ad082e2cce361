#include "apps/web/picture_session.hpp"

#include "apps/engine/request/render_options.hpp"
#include "apps/engine/trade/trade_error.hpp"
#include "apps/web/session_report.hpp"

#include <algorithm>
#include <utility>

namespace halflit::web {
void PictureSession::forget_scene() { job_.reset(); }

Result<void> PictureSession::apply(const std::string& scene, const std::vector<std::string>& flags) {
    engine::RenderOptions options;
    const auto groups = engine::render_flags(options, kUsualSize);
    auto read = engine::read_flags(groups, flags);
    if (!read) return tl::unexpected(read.error());
    if (options.film.views.size() > 1) return fail(ErrorCode::usage, "--view: one side for each picture");
    options.scene = scene;
    options.execution.threads = 1;
    options.may_want_reference = true;
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;  // of the 2 GB that the module may take
    std::uint64_t& most = options.load.limits.max_geometry_bytes;
    most = std::min(most, kMostBytes);
    auto& [scene_flags, light_flags, draw_flags] = *read;
    scene_flags.insert(0, scene + "\n");
    if (job_ && scene_flags == scene_flags_) {
        const bool same_light = light_flags == light_flags_;
        light_flags_ = "?";  // until it is done
        if (const auto changed = engine::change_job(*job_, options, same_light); !changed) {
            job_.reset();
            return changed;
        }
    } else {
        job_.reset();  // its memory first
        auto job = engine::make_render_job(options);
        if (!job) return tl::unexpected(job.error());
        job_.emplace(std::move(*job));
        ++loads_;
        scene_flags_ = std::move(scene_flags);
    }
    light_flags_ = std::move(light_flags);
    job_->execution.time_limit_s = options.timeout_s;  // of this picture, beside what the loading took
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
    comparison_.clear();
    return {};
}

std::string PictureSession::report() const {
    if (!comparison_.empty()) return comparison_;
    return job_ ? picture_report(*job_, last_, picture_, loads_) : "{}";
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
