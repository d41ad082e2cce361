// The source of a scene: a file, standard input, or code.
#pragma once

#include "apps/engine/job/parts.hpp"
#include "apps/engine/request/render_options.hpp"
#include "halflit/error.hpp"
#include "halflit/image.hpp"
#include "halflit/model.hpp"
#include "halflit/scene.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

struct SceneSource {
    std::string name;               ///< name for messages: the path, "standard input", or the built-in name
    std::shared_ptr<Scene> scene;   ///< of this source alone; keeps its address when the source is moved
    std::optional<SceneInfo> file;  ///< counts for a file or standard input; the unit of such a scene's lights is not known
    std::vector<std::string> warnings;
    std::vector<AnimationInfo> animations{};  ///< of the file
    int animation = -1;                       ///< the one that poses the scene; -1: none
    Placement placement{};                    ///< where the file's model lies
    std::shared_ptr<const Motion> motion{};   ///< for pose_at(); null without LoadOptions::keep_animations
    std::shared_ptr<Parts> parts;             ///< of the scene as it was loaded, and what was added to them; never null
};

/// Unit of length, and how many of it a unit of the drawn world is.
struct ShownUnit {
    std::string name;  ///< "mm", "m", or empty: the format has none
    double per_drawn_unit = 1.0;
};
/// The unit of the scene's file.
[[nodiscard]] ShownUnit file_unit(const SceneSource& source);

/// Name of standard input in messages.
inline constexpr const char* kStandardInputName = "standard input";

/// Keeps scenes that were loaded, for a program that draws one file many times.
class SceneKeeper {
public:
    virtual ~SceneKeeper() = default;
    /// Returns what load_scene() returns. The caller may change the scene.
    [[nodiscard]] virtual Result<SceneSource> load(const ModelRequest& model) = 0;
};

/// Requires: standard input, if it is the scene, was read. An empty name is the demo scene. Built-in names come before files: a file called
/// "demo" is given as "./demo".
[[nodiscard]] Result<SceneSource> load_scene(const ModelRequest& model);

/// True for what load_scene can be asked for: a built-in scene, standard input ("-"), a model's name or a file that is there.
[[nodiscard]] bool is_scene(const std::string& name);

/// Reads standard input to its end. Fails above `max_bytes`, so that endless input is refused, and after the time limit; 0: none.
[[nodiscard]] Result<std::vector<std::byte>> read_standard_input(std::size_t max_bytes, double time_limit_s);

/// "sky" is the built-in environment; anything else is a file.
[[nodiscard]] Result<EnvironmentImage> find_environment(const std::string& name);

}  // namespace halflit::engine
