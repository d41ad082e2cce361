// The flags that make a picture. render, bench and info take the same ones, so that what is measured or described is what is drawn.
#pragma once

#include "apps/halflit/values.hpp"
#include "apps/io/gltf_loader.hpp"
#include "apps/io/lobe_name.hpp"
#include "raster/view/camera.hpp"
#include "raster/renderer.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace halflit::cli {

struct RenderOptions {
    std::string scene;  ///< a file, "-" for standard input, or a built-in scene
    std::optional<PictureSize> size;
    raster::Region region;  ///< width 0: all
    int samples = 1;
    Vec4f background_linear{0, 0, 0, 0};
    bool background_environment = false;

    std::optional<std::string> camera;
    raster::ViewSettings view;
    bool own_view = false;  ///< one of the view's flags was given

    std::optional<std::string> lobe_name;
    io::LobeParameters lobe;
    shading::SpecularModel specular = shading::SpecularModel::blinn;
    bool normalize_specular = true;
    shading::Accuracy accuracy = shading::Accuracy::exact;
    double max_error_codes = 0.0;
    shading::TextureDetail texture_detail = shading::TextureDetail::full;
    shading::ShadingRate rate = shading::ShadingRate::pixel;
    std::optional<Vec3f> ambient_linear;
    std::vector<shading::Light> lights;
    bool scene_lights = true;
    std::string environment;  ///< a file, "sky", or empty
    bool environment_sun = true;
    float environment_rotate_deg = 0.0f;
    int sh_order = 0;  ///< 0: from the bound
    shading::ShadowMode shadows = shading::ShadowMode::soft_split;
    int shadow_size = 2048;
    bool shadow_terminator = false;
    int shadow_memory_mib = 256;
    float shadow_fade = 0.0f;  ///< 0: from object size and wrap
    std::optional<float> exposure;  ///< a factor; none: chosen from the lights

    std::optional<shading::Isa> isa;
    int threads = 0;
    int tile_size = 64;

    io::LoadOptions load;
};

/// The lobe that the flags choose for materials that bring none; nothing when they choose none.
[[nodiscard]] Result<std::optional<shading::Lobe>> chosen_lobe(const RenderOptions& options);

/// Adds the flags to a sub-command; `options` must outlive it. `scene_required` says so of the SCENE argument.
void add_render_options(CLI::App& app, RenderOptions& options, bool scene_required);

}  // namespace halflit::cli
