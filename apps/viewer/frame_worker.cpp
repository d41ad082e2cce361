#include "apps/viewer/frame_worker.hpp"

#include "apps/engine/answers/pixel_story_json.hpp"
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/answers/scene_description.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <new>
#include <utility>

namespace halflit::viewer {
namespace {

std::vector<bool> own_lobes_of(const Scene& scene) {
    std::vector<bool> own;
    for (const Material& material : scene.materials) own.push_back(material.has_own_lobe);
    return own;
}

/// Makes lights of the environment's suns, so that each has its controls. Returns all lights.
const std::vector<Light>& spread_suns(Lighting& light) {
    light.lights = light.all_lights();
    light.suns = false;
    return light.lights;
}

}  // namespace

FrameWorker::FrameWorker(engine::RenderJob job, engine::LightRequest light, std::function<void()> notify)
    : job_(std::move(job)),
      light_(std::move(light)),
      background_environment_(job_.settings.background_environment),
      notify_(std::move(notify)),
      start_camera_(job_.camera),
      start_settings_(job_.settings),
      own_lobes_(own_lobes_of(job_.scene())),
      start_lights_(spread_suns(job_.light)),
      sky_{Sky::as_started, light_.environment_rotate_deg} {
    job_.timeout_s = 0.0;  // it was for loading
    job_.execution.cancelled = [this] { return given_up_.load(std::memory_order_relaxed); };
    thread_ = std::thread([this] { run(); });
}

FrameWorker::~FrameWorker() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        given_up_ = true;
    }
    asked_.notify_one();
    thread_.join();
}

bool FrameWorker::idle() const {
    const std::lock_guard lock(mutex_);
    return !busy_ && !result_;
}

void FrameWorker::begin(FrameRequest request) {
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
        busy_ = true;
        given_up_ = false;
    }
    asked_.notify_one();
}

void FrameWorker::give_up() {
    const std::lock_guard lock(mutex_);
    const bool quick = request_ && (request_->pixel || request_->step.samples == 1);
    if (busy_ && !quick) given_up_ = true;
}

std::optional<DrawnFrame> FrameWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(result_, std::nullopt);
}

void FrameWorker::run() {
    for (;;) {
        FrameRequest request;
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return ending_ || (busy_ && !result_); });
            if (ending_) return;
            request = *request_;
        }
        DrawnFrame frame = answer(request);
        {
            const std::lock_guard lock(mutex_);
            result_ = std::move(frame);
            busy_ = false;
        }
        notify_();
    }
}

DrawnFrame FrameWorker::answer(const FrameRequest& request) {
    DrawnFrame frame;
    frame.step = request.step;
    const engine::Stopwatch watch;
    Result<void> done;
    try {
        done = apply(request, frame);
        if (done) done = draw(request, frame);
    } catch (const std::bad_alloc&) {
        done = fail(ErrorCode::limit, "out of memory");
    }
    frame.draw_ms = watch.ms();
    if (done) return frame;
    frame.picture = {};
    frame.dropped = done.error().code == ErrorCode::cancelled;
    if (!frame.dropped) frame.error = done.error();
    return frame;
}

Result<void> FrameWorker::apply_lobes(const Controls& controls) {
    std::vector<Material>& materials = job_.scene().materials;
    const bool over = controls.over_own_lobes && !controls.own_lobes;
    bool changed = false;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const bool own = own_lobes_[i] && !over;
        changed = changed || materials[i].has_own_lobe != own;
        materials[i].has_own_lobe = own;
    }
    if (!changed) return {};
    return job_.prepared->update({.materials = true}, job_.execution);
}

Result<void> FrameWorker::apply(const FrameRequest& request, DrawnFrame& frame) {
    const Controls& controls = request.controls;
    std::vector<Light>& lights = job_.light.lights;
    if (!(controls.sky == sky_)) {
        job_.camera = start_camera_;  // the studio stands as it did at the start
        const bool background = job_.settings.background_environment = background_environment_ && controls.sky.sky == Sky::as_started;
        if (const auto changed = engine::change_light(job_, with_sky(light_, controls.sky)); !changed) return changed;
        sky_ = controls.sky;
        start_lights_ = spread_suns(job_.light);
        start_settings_.exposure = job_.settings.exposure;
        start_settings_.background_environment = background;
        frame.lights = light_controls(lights);
    }
    Controls now = controls;
    if (frame.lights) now.lights = *frame.lights;
    lights = lights_of(now, start_lights_);
    if (const auto applied = apply_lobes(now); !applied) return applied;
    job_.settings = settings_of(now, start_settings_);
    job_.camera = request.camera;
    const int divisor = request.pixel ? 1 : request.step.divisor;
    job_.width = std::max(1, request.width / divisor);
    job_.height = std::max(1, request.height / divisor);
    job_.settings.region = {0, 0, job_.width, job_.height};
    return {};
}

Result<void> FrameWorker::draw(const FrameRequest& request, DrawnFrame& frame) {
    if (request.pixel) {
        auto story = explain_pixel(probe_, *job_.prepared, job_.light, job_.camera, job_.settings, {job_.width, job_.height},
                                   request.pixel->x, request.pixel->y, job_.timed_execution());
        if (!story) return tl::unexpected(story.error());
        frame.story = engine::in_file(std::move(*story), job_.source.placement);
        return {};
    }
    const int all_samples = job_.settings.samples;
    job_.settings.samples = request.step.samples;
    frame.picture = engine::make_image(job_, false);
    const auto rendered =
        renderer_.render(*job_.prepared, job_.light, job_.camera, job_.settings, engine::target_of(job_, frame.picture), job_.execution);
    if (!rendered) return tl::unexpected(rendered.error());
    frame.exposure = start_settings_.exposure;
    frame.size_ms = rendered->total_ms - rendered->ms.prepare - rendered->ms.plan - rendered->ms.shadows;
    engine::Json report;
    engine::add_frame(report, job_, *rendered, frame.picture);
    frame.report = engine::to_lines(report);
    if (!request.step.final_one) return {};
    job_.settings.samples = all_samples;
    const auto plan = engine::describe_plan(job_);
    if (!plan) return tl::unexpected(plan.error());
    frame.plan = *plan;
    return {};
}

}  // namespace halflit::viewer
