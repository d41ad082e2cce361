// The public entry: a scene and a camera in, pixels out.
#pragma once

#include "raster/framebuffer.hpp"
#include "raster/report.hpp"
#include "raster/scene/camera.hpp"
#include "raster/scene/prepared_scene.hpp"
#include "raster/scene/scene.hpp"
#include "raster/settings.hpp"

#include <memory>

namespace halflit::raster {

/// Draws frames. Keeps working memory between frames, and the plan, the shadow maps and the view's geometry: the next frame of the same
/// prepared scene uses each of these again if its inputs are unchanged. A Renderer draws one frame at a time; any number of Renderers may
/// draw at once.
class Renderer {
public:
    Renderer();
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Draws a prepared scene. For sequences of pictures: PreparedScene::update tells what changed.
    Result<RenderReport> render(const PreparedScene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

    /// Prepares the scene and draws it. Anything in it may have changed since the last frame.
    Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

    /// Drops the plan, light distances, shadow maps and geometry of earlier frames. Keeps their memory, and results that depend on an
    /// environment or a material alone. The next frame does the same work as after a change of the whole scene's geometry.
    void forget_frames();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Draws one picture with a temporary Renderer.
Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

}  // namespace halflit::raster
