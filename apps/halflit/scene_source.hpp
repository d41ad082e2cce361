// Where a scene comes from: a file, standard input, or code.
#pragma once

#include "apps/halflit/render_options.hpp"
#include "apps/io/gltf_loader.hpp"
#include "raster/scene/scene.hpp"
#include "shading/result.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace halflit::cli {

struct SceneSource {
    std::string name;                      ///< for people: the path, "standard input", or the built-in name
    std::unique_ptr<raster::Scene> scene;  ///< stays where it is while the source moves
    std::optional<io::SceneInfo> file;     ///< of a file or standard input, whose lights are in their author's unit
    std::vector<std::string> warnings;
};

/// No name is the demo scene; built-in names come before files (a file called "demo" is "./demo").
[[nodiscard]] Result<SceneSource> load_scene(const RenderOptions& options);

}  // namespace halflit::cli
