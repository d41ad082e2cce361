// From flags to a picture that can be drawn: the scene loaded and prepared, its camera, light and exposure chosen.
#pragma once

#include "apps/halflit/render_options.hpp"
#include "apps/halflit/scene_source.hpp"
#include "raster/renderer.hpp"
#include "shading/result.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct RenderJob {
    SceneSource source;                             ///< with the job's lights and ambient
    std::optional<raster::PreparedScene> prepared;  ///< of that scene
    raster::Camera camera;
    raster::Settings settings;  ///< the region is never empty
    int width = 0, height = 0;
    double load_ms = 0, prepare_ms = 0;
    std::vector<std::string> warnings;

    [[nodiscard]] raster::Scene& scene() { return *source.scene; }
    [[nodiscard]] const raster::Scene& scene() const { return *source.scene; }
};

/// `usual` is the size when neither the flags nor the file's camera choose one. What can be found wrong without loading the scene is found
/// before.
[[nodiscard]] Result<RenderJob> make_render_job(const RenderOptions& options, PictureSize usual);

/// Memory for the whole picture, with the buffers asked for.
[[nodiscard]] raster::Image make_image(const RenderJob& job, bool linear);
[[nodiscard]] raster::FramebufferView view_of(raster::Image& image);

/// The region of the picture that was drawn; the picture itself when that is all of it.
[[nodiscard]] raster::Image cropped(raster::Image image, const raster::Region& region);

}  // namespace halflit::cli
