// The window's loop: events in, requests to the worker, pictures and panel out. It never waits for a picture.
#include "apps/viewer/viewer.hpp"

#include "apps/engine/answers/pixel_story_text.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/viewer/frame_worker.hpp"
#include "apps/viewer/orbit_camera.hpp"
#include "apps/viewer/window/gui.hpp"
#include "apps/viewer/window/panels.hpp"
#include "apps/viewer/window/rehearsal_mouse.hpp"
#include "apps/viewer/window/sdl.hpp"
#include "apps/viewer/window/surface.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace halflit::viewer {
namespace {

constexpr int kPanelWidth = 400;
constexpr int kClickReach = 3;  // pixels that a click may move

/// Called at the end of the scope.
template <class End>
class AtEnd {
public:
    explicit AtEnd(End end) : end_(std::move(end)) {}
    ~AtEnd() { end_(); }
    AtEnd(const AtEnd&) = delete;
    AtEnd& operator=(const AtEnd&) = delete;

private:
    End end_;
};

bool has_own_lobes(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) { return material.has_own_lobe; });
}

class Viewer {
public:
    Viewer(const Sdl& sdl, engine::RenderJob job, const engine::RenderOptions& options, const ViewerOptions& how)
        : sdl_(sdl),
          how_(how),
          window_(sdl),
          orbit_(job.camera, job.film.bounds),
          panel_{controls_of(job, options), controls_of(job, options), has_own_lobes(job.scene())},
          refinement_(job.settings.samples),
          rehearsal_(how.rehearsal, static_cast<int>(OrbitCamera::kPixelsOfTurn)),
          mouse_(sdl),
          done_event_(SDL_USEREVENT) {
        panel_.tab = how.tab;
        picture_width_ = started_width_ = job.width, picture_height_ = started_height_ = job.height;
        texts_.scene = fmt::format("{}: {} triangles", job.source.name, job.prepared->triangle_count());
        texts_.pixel = "A click on the picture tells how its pixel came about.";
        for (const std::string& warning : job.warnings) texts_.report += "warning: " + warning + "\n";
        texts_.exposure = job.settings.exposure;
        placement_ = job.source.placement;
        title_ = "halflit: " + job.source.name;
        node_name_ = engine::names_of(job.source.parts);
        worker_ = std::make_unique<FrameWorker>(std::move(job), options, [this] { wake(); });
    }

    Result<ViewerSummary> run() {
        if (const auto opened = window_.open(title_, picture_width_ + kPanelWidth, picture_height_); !opened)
            return tl::unexpected(opened.error());
        gui_ = std::make_unique<Gui>(sdl_, window_.renderer);
        sdl_.StartTextInput();
        while (!ended_) turn_of_loop();
        worker_.reset();
        if (failure_) return fail(failure_->code, "view: " + failure_->message);
        summary_.width = picture_width_, summary_.height = picture_height_;
        summary_.frame_ms = rehearsal_.intervals();
        const std::size_t kept = summary_.frame_ms.size();
        summary_.draw_ms.resize(std::min(kept, summary_.draw_ms.size()));
        summary_.divisors.resize(summary_.draw_ms.size());
        if (!how_.screenshot.empty())
            if (const auto written = write_image(how_.screenshot, screenshot_); !written) return tl::unexpected(written.error());
        return std::move(summary_);
    }

private:
    /// From the worker's thread: the loop may sleep in WaitEventTimeout.
    void wake() {
        SDL_Event event{};
        event.type = done_event_;
        sdl_.PushEvent(&event);
    }

    void turn_of_loop() {
        wait();
        const engine::Stopwatch busy;
        take_result();
        rehearse();
        SDL_Event event;
        // SDL may end a round of its queue before events that were pushed just now.
        for (int round = 0; round < 2; ++round)
            while (sdl_.PollEvent(&event) != 0) handle(event);
        ask();
        if (redraw_ > 0) present();
        summary_.worst_loop_ms = std::max(summary_.worst_loop_ms, busy.ms());
    }

    void wait() {
        if (redraw_ > 0) return;
        constexpr double kLongest = 1000.0;
        double ms = refinement_.wait_ms(clock_.ms()).value_or(kLongest);
        if (!worker_->idle()) ms = kLongest;  // its result wakes the loop
        if (how_.rehearsal.wanted) ms = std::min(ms, 5.0);
        const int whole = static_cast<int>(std::clamp(ms, 0.0, kLongest)) + (ms > 0.0 ? 1 : 0);
        SDL_Event event;
        if (whole > 0 && sdl_.WaitEventTimeout(&event, whole) != 0) handle(event);
    }

    void take_result() {
        new_picture_ = false;
        auto frame = worker_->take();
        if (!frame) return;
        redraw_ = std::max(redraw_, 1);
        if (frame->lights) panel_.controls.lights = std::move(*frame->lights);
        texts_.error = frame->error ? frame->error->message : "";
        if (frame->error && how_.rehearsal.wanted) {
            failure_ = frame->error;
            ended_ = true;
        }
        if (frame->story) {
            texts_.pixel = engine::story_text(*frame->story, node_name_);
            texts_.marked = !moved_since_request_;
            texts_.mark_x = frame->story->x, texts_.mark_y = frame->story->y;
            panel_.tab = Tab::pixel;
            panel_.select_tab = true;
            redraw_ = 3;  // a tab comes to the front with the frame after the next one
            summary_.story = std::move(frame->story);
            story_shown_ = true;
            return;
        }
        if (telling_) return;  // without a story: that failed
        refinement_.drawn(frame->step, frame->size_ms, frame->dropped);
        if (frame->error || frame->dropped) return;
        if (summary_.first_picture_ms == 0.0) summary_.first_picture_ms = clock_.ms();
        if (refinement_.finished()) summary_.finished_ms = clock_.ms() - moved_ms_;
        if (rehearsal_.turning()) {
            summary_.draw_ms.push_back(frame->draw_ms);
            summary_.divisors.push_back(frame->step.divisor);
        }
        window_.show(frame->picture);
        new_picture_ = true;
        texts_.report = frame->report;
        texts_.exposure = frame->exposure;
        if (!frame->plan.empty()) texts_.plan = frame->plan;
        shown_step_ = frame->step;
        shown_ms_ = frame->draw_ms;
    }

    void rehearse() {
        if (mouse_.waits()) return;
        const bool finished = refinement_.finished() && worker_->idle();
        const RehearsalStep step = rehearsal_.next({clock_.ms(), new_picture_, finished && redraw_ <= 1, story_shown_ && redraw_ == 0});
        switch (step.gesture) {
            case Gesture::press:
                mouse_.press(picture_width_ / 2, picture_height_ / 2);
                break;
            case Gesture::drag:
                mouse_.drag(step.dx);
                break;
            case Gesture::release:
                mouse_.release();
                break;
            case Gesture::click:
                mouse_.press(how_.rehearsal.click->x, how_.rehearsal.click->y);
                mouse_.release();
                break;
            case Gesture::end:
                last_present_ = true;
                redraw_ = 1;
                break;
            case Gesture::none:
                break;
        }
    }

    void moved() {
        texts_.marked = false;
        clicked_.reset();
        moved_since_request_ = true;
        moved_ms_ = clock_.ms();
        refinement_.moved(moved_ms_);
        worker_->give_up();
        redraw_ = std::max(redraw_, 1);
    }

    void handle(const SDL_Event& event) {
        if (event.type == done_event_) return;
        redraw_ = std::max(redraw_, 2);  // a widget shows what an event did one frame later
        gui_->handle(event);
        mouse_.handled(event);
        switch (event.type) {
            case SDL_QUIT:
                ended_ = true;
                break;
            case SDL_WINDOWEVENT:
                if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) resized();
                break;
            case SDL_MOUSEBUTTONDOWN:
                if (event.button.x >= picture_width_) break;
                held_ = event.button.button;
                wandered_ = 0;
                break;
            case SDL_MOUSEBUTTONUP:
                if (event.button.button != held_) break;
                if (held_ == SDL_BUTTON_LEFT && wandered_ <= kClickReach && event.button.x < picture_width_)
                    clicked_ = FrameRequest::Pixel{std::max(0, event.button.x), std::clamp(event.button.y, 0, picture_height_ - 1)};
                held_ = 0;
                break;
            case SDL_MOUSEMOTION:
                drag(event.motion);
                break;
            case SDL_MOUSEWHEEL:
                if (pointer_x_ >= picture_width_ || event.wheel.y == 0) break;
                orbit_.zoom(event.wheel.y);
                moved();
                break;
            case SDL_KEYDOWN:
                if (event.key.keysym.sym == SDLK_q && (event.key.keysym.mod & KMOD_CTRL) != 0) ended_ = true;
                break;
            default:
                break;
        }
    }

    void drag(const SDL_MouseMotionEvent& motion) {
        pointer_x_ = motion.x;
        if (held_ == 0) return;
        const int before = wandered_;
        wandered_ += std::abs(motion.xrel) + std::abs(motion.yrel);
        if (wandered_ <= kClickReach && before <= kClickReach) return;
        if (held_ == SDL_BUTTON_LEFT)
            orbit_.turn(motion.xrel, motion.yrel);
        else
            orbit_.pan(motion.xrel, motion.yrel, picture_height_);
        moved();
    }

    void resized() {
        int width = 0, height = 0;
        sdl_.GetWindowSize(window_.window, &width, &height);
        const int picture = std::max(64, width - kPanelWidth);
        if (picture == picture_width_ && height == picture_height_) return;
        picture_width_ = picture, picture_height_ = std::max(1, height);
        moved();
    }

    /// Gives the worker its next task.
    void ask() {
        if (!worker_->idle()) return;
        FrameRequest request{orbit_.camera(), panel_.controls, picture_width_, picture_height_, {}};
        telling_ = clicked_ && refinement_.finished();
        moved_since_request_ = false;
        if (telling_) {
            request.pixel = std::exchange(clicked_, std::nullopt);
            worker_->begin(std::move(request));
            return;
        }
        const auto step = refinement_.next(clock_.ms());
        if (!step) return;
        request.step = *step;
        refinement_.began(*step);
        worker_->begin(std::move(request));
    }

    /// Where they differ from those of the start.
    [[nodiscard]] std::string view_flags() const {
        const bool resized = picture_width_ != started_width_ || picture_height_ != started_height_;
        const std::string size = resized ? fmt::format("--size {}x{}", picture_width_, picture_height_) : "";
        const std::string view = orbit_.flags(static_cast<double>(picture_width_) / picture_height_, placement_);
        return size + (size.empty() || view.empty() ? "" : " ") + view;
    }

    void present() {
        const bool shows_picture = new_picture_;
        int width = 0, height = 0;
        sdl_.GetWindowSize(window_.window, &width, &height);
        sdl_.SetRenderDrawColor(window_.renderer, 30, 30, 34, 255);
        sdl_.RenderClear(window_.renderer);
        const SDL_Rect place{0, 0, picture_width_, picture_height_};
        if (window_.picture != nullptr) sdl_.RenderCopy(window_.renderer, window_.picture, nullptr, &place);
        texts_.status = fmt::format("{}x{}{}, {} sample{}: {:.1f} ms{}", picture_width_, picture_height_,
                                    shown_step_.divisor > 1 ? fmt::format(" / {}", shown_step_.divisor) : "", shown_step_.samples,
                                    shown_step_.samples > 1 ? "s" : "", shown_ms_,
                                    rate_ > 0.0 && !refinement_.finished() ? fmt::format(", {:.0f} a second", rate_) : "");
        texts_.view = view_flags();
        gui_->begin(width, height, static_cast<float>(since_present_.ms() / 1000.0));
        const SkyControls sky = panel_.controls.sky;
        if (panel_.draw(texts_, picture_width_, width - picture_width_, height)) {
            if (!(panel_.controls.sky == sky)) panel_.controls.lights.clear();  // they come back with the new sky
            refinement_.set_samples(panel_.controls.samples, clock_.ms());
            moved();
        }
        if (panel_.reset_view) {
            orbit_.reset();
            moved();
        }
        gui_->end();
        if (last_present_) {
            screenshot_ = window_.screenshot(width, height);
            summary_.window_width = width, summary_.window_height = height;
            ended_ = true;
        }
        sdl_.RenderPresent(window_.renderer);
        since_present_ = {};
        --redraw_;
        if (!shows_picture) return;
        rehearsal_.shown(clock_.ms());
        const double interval = since_picture_.ms();
        since_picture_ = {};
        rate_ = interval > 0.0 && interval < 500.0 ? (rate_ > 0.0 ? 0.8 * rate_ + 0.2 * 1000.0 / interval : 1000.0 / interval) : 0.0;
    }

    const Sdl& sdl_;
    const ViewerOptions& how_;
    Surface window_;
    OrbitCamera orbit_;
    Panel panel_;
    PanelTexts texts_;
    Refinement refinement_;
    Rehearsal rehearsal_;
    RehearsalMouse mouse_;
    const Uint32 done_event_;
    std::string title_;
    engine::NameOfInstance node_name_;
    Placement placement_;  ///< where the file's model is drawn
    int picture_width_ = 0, picture_height_ = 0, started_width_ = 0, started_height_ = 0;
    std::unique_ptr<Gui> gui_;

    engine::Stopwatch clock_, since_present_, since_picture_;
    double rate_ = 0;  ///< pictures a second
    double moved_ms_ = 0;
    bool new_picture_ = false, telling_ = false, story_shown_ = false, ended_ = false, last_present_ = false;
    int redraw_ = 2;       ///< frames of the panel that are due
    DrawStep shown_step_;  ///< of the picture in the window
    double shown_ms_ = 0;
    Uint8 held_ = 0;    ///< button that was pressed on the picture
    int wandered_ = 0;  ///< pixels since then
    int pointer_x_ = 0;
    bool moved_since_request_ = false;
    std::optional<FrameRequest::Pixel> clicked_;
    std::optional<Error> failure_;
    Image screenshot_;
    ViewerSummary summary_;
    std::unique_ptr<FrameWorker> worker_;  ///< last: its thread calls wake()
};

}  // namespace

bool has_viewer() { return true; }

std::string missing_libraries() { return ""; }

Result<ViewerSummary> run_viewer(engine::RenderJob job, const engine::RenderOptions& options, const ViewerOptions& how) {
    const auto sdl = load_sdl();
    if (!sdl) return tl::unexpected(sdl.error());
    // Drawn by the processor, as the picture is, unless SDL_RENDER_DRIVER says otherwise. Signals are the program's.
    sdl->SetHint(SDL_HINT_RENDER_DRIVER, "software");
    sdl->SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    sdl->SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    sdl->SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    if (sdl->Init(SDL_INIT_VIDEO) != 0) {
        const std::string reason = sdl->GetError();
        return fail(ErrorCode::usage, "view: no display: " + reason);
    }
    const AtEnd quit([&sdl] { sdl->Quit(); });
    const std::string_view driver = sdl->GetCurrentVideoDriver();
    if (!how.rehearsal.wanted && (driver == "offscreen" || driver == "dummy"))
        return fail(ErrorCode::usage, "view: no display; --orbit, --click and --screenshot do without");
    return Viewer(*sdl, std::move(job), options, how).run();
}

}  // namespace halflit::viewer
