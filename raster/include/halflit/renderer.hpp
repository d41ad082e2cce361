// The entry: a scene and a camera in, pixels out.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/prepared_scene.hpp"
#include "halflit/report.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "halflit/target.hpp"

#include <memory>

namespace halflit {

/// Draws frames. Keeps working memory between frames, and the plan, the shadow maps and the view's geometry: the next frame of the same
/// prepared scene uses each of these again if its inputs are unchanged. A Renderer draws one frame at a time; any number of Renderers may
/// draw at once. Calls fail (usage) for settings out of range, (bad_input) for a faulty scene, (limit) where memory ends.
class Renderer {
public:
    HALFLIT_API Renderer();
    HALFLIT_API ~Renderer();
    /// @{
    /// A Renderer that was moved from may only be assigned to or destroyed.
    HALFLIT_API Renderer(Renderer&&) noexcept;
    HALFLIT_API Renderer& operator=(Renderer&&) noexcept;
    /// @}

    /// @{
    /// Draws a prepared scene. For sequences of pictures: PreparedScene::update tells what changed. The light is the scene's own, or
    /// `light`, which need not stay the same.
    [[nodiscard]] HALFLIT_API Result<RenderReport> render(const PreparedScene& scene, const Lighting& light, const Camera& camera,
                                                          const Settings& settings, const Target& target, const Execution& execution = {});
    [[nodiscard]] HALFLIT_API Result<RenderReport> render(const PreparedScene& scene, const Camera& camera, const Settings& settings,
                                                          const Target& target, const Execution& execution = {});

    /// @}

    /// @{
    /// Prepares the scene and draws it. Anything in it may have changed since the last frame.
    [[nodiscard]] HALFLIT_API Result<RenderReport> render(const Scene& scene, const Lighting& light, const Camera& camera,
                                                          const Settings& settings, const Target& target, const Execution& execution = {});
    [[nodiscard]] HALFLIT_API Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings,
                                                          const Target& target, const Execution& execution = {});

    /// @}

    /// Finds the cheapest settings that keep a budget in this view, by probes: pixels that a hash chooses are drawn in the settings' own
    /// quality and in cheaper ones. That takes about as long as a frame, so it is for sequences: measure some of the views, and draw all
    /// with with_share. known: what was found for other views; the result is at least as careful. Other views are not checked. The whole
    /// picture counts, background included, whatever the region. Fails (usage) for settings with an error budget, or an accuracy other than
    /// exact.
    [[nodiscard]] HALFLIT_API static Result<MeasuredShare> measure(const PreparedScene& scene, const Lighting& light, const Camera& camera,
                                                                   const Settings& settings, const ShareBudget& budget, int width,
                                                                   int height, const MeasuredShare* known = nullptr,
                                                                   const Execution& execution = {});

    /// Drops the plan, light distances, shadow maps, the grid of what hides the surroundings, contact shadows and geometry of earlier
    /// frames. Keeps their memory, and results that depend on an environment or a material alone. The next frame does the same work as
    /// after a change of the whole scene's geometry.
    HALFLIT_API void forget_frames();

private:
    struct Impl;
    class Measuring;
    std::unique_ptr<Impl> impl_;
};

/// The settings with the measured samples, anisotropy and shadow size.
[[nodiscard]] HALFLIT_API Settings with_share(Settings settings, const MeasuredShare& measured);

/// @{
/// Draws one picture with a temporary Renderer.
[[nodiscard]] HALFLIT_API Result<RenderReport> render(const Scene& scene, const Lighting& light, const Camera& camera,
                                                      const Settings& settings, const Target& target, const Execution& execution = {});
[[nodiscard]] HALFLIT_API Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings,
                                                      const Target& target, const Execution& execution = {});
/// @}

}  // namespace halflit
