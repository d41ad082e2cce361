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

/// Keeps working memory between frames, and all that a next frame of the same prepared scene can use again: the plan, shadow maps, and the
/// view's geometry, each while what it is made from stays the same. One frame at a time for each Renderer, any number of Renderers at once.
class Renderer {
public:
    Renderer();
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// For pictures one after the other: the scene was prepared beforehand, and is told what changes.
    Result<RenderReport> render(const PreparedScene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

    /// The short way: prepares the scene first, every time. Anything may have changed since the last frame.
    Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

    /// Forgets what the last frames left for the next one, but for their memory and what belongs to an environment or a material alone. The
    /// next frame is drawn as after a change of the whole scene's geometry.
    void forget_frames();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One picture, with its own Renderer.
Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target);

}  // namespace halflit::raster
