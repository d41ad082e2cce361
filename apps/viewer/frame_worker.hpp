// A thread that draws, so that the window answers while a picture is made.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "apps/viewer/controls.hpp"
#include "apps/viewer/refinement.hpp"
#include "halflit/explain.hpp"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace halflit::viewer {

/// A picture to draw, or a pixel of it to tell about.
struct FrameRequest {
    Camera camera;
    Controls controls;
    int width = 0, height = 0;  ///< of the window's picture; the step divides them
    DrawStep step;
    struct Pixel {
        int x, y;
    };
    std::optional<Pixel> pixel{};  ///< tell about it instead
};

struct DrawnFrame {
    DrawStep step;
    Image picture;         ///< empty after an error, and where it was dropped
    double draw_ms = 0;    ///< of the request, changes of the light included
    double size_ms = 0;    ///< the part of it that depends on the picture's size: without plan and shadow maps
    bool dropped = false;  ///< given up
    std::optional<Error> error{};
    std::string report;                                 ///< lines
    std::string plan;                                   ///< lines; empty for quick pictures
    float exposure = 1;                                 ///< factor on all light, without the control's
    std::optional<std::vector<LightControl>> lights{};  ///< the scene has other lights than before
    std::optional<PixelStory> story{};
};

/// One request at a time. The job belongs to the thread.
class FrameWorker {
public:
    /// notify: called on the thread when a result lies ready.
    FrameWorker(engine::RenderJob job, engine::LightRequest light, std::function<void()> notify);
    ~FrameWorker();
    FrameWorker(const FrameWorker&) = delete;
    FrameWorker& operator=(const FrameWorker&) = delete;

    [[nodiscard]] bool idle() const;
    /// Requires: idle.
    void begin(FrameRequest request);
    /// Gives up the picture in the making, if it has more than one sample.
    void give_up();
    /// The result of the last request, once.
    [[nodiscard]] std::optional<DrawnFrame> take();

private:
    void run();
    DrawnFrame answer(const FrameRequest& request);
    Result<void> apply_lobes(const Controls& controls);
    Result<void> apply(const FrameRequest& request, DrawnFrame& frame);
    Result<void> draw(const FrameRequest& request, DrawnFrame& frame);

    engine::RenderJob job_;
    const engine::LightRequest light_;  ///< of the flags
    const bool background_environment_;
    const std::function<void()> notify_;
    const Camera start_camera_;
    Settings start_settings_;            ///< with the exposure of the present sky
    const std::vector<bool> own_lobes_;  ///< Material::has_own_lobe, as the scene says
    std::vector<Light> start_lights_;    ///< of the present sky, before the controls
    SkyControls sky_;                    ///< the present one
    Renderer renderer_, probe_;          ///< of pictures, and of single pixels

    mutable std::mutex mutex_;
    std::condition_variable asked_;
    std::optional<FrameRequest> request_;
    std::optional<DrawnFrame> result_;
    bool busy_ = false, ending_ = false;
    std::atomic<bool> given_up_ = false;
    std::thread thread_;  ///< last, as it uses all above
};

}  // namespace halflit::viewer
