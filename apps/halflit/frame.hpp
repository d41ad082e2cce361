// From flags to a frame that can be drawn: the scene loaded, its camera, light and exposure chosen.
#pragma once

#include "apps/halflit/render_options.hpp"
#include "apps/halflit/scene_source.hpp"
#include "raster/renderer.hpp"
#include "shading/result.hpp"

namespace halflit::cli {

struct Frame {
    SceneSource source;  ///< with the frame's lights and ambient
    raster::Camera camera;
    raster::Settings settings;  ///< the region is never empty
    int width = 0, height = 0;
    double load_ms = 0;
    std::vector<std::string> warnings;
};

/// `usual` is the size when neither the flags nor the file's camera choose one. What can be found wrong without loading the scene is found
/// before.
[[nodiscard]] Result<Frame> make_frame(const RenderOptions& options, PictureSize usual);

/// A picture for the whole frame, with the buffers asked for.
[[nodiscard]] raster::Image make_image(const Frame& frame, bool linear);
[[nodiscard]] raster::FramebufferView view_of(raster::Image& image);

/// The frame's region of the picture; the picture itself when that is all of it.
[[nodiscard]] raster::Image cropped(raster::Image image, const raster::Region& region);

}  // namespace halflit::cli
