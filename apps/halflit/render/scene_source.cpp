#include "apps/halflit/render/scene_source.hpp"

#include "apps/halflit/program/file_names.hpp"
#include "apps/halflit/render/built_in_scenes.hpp"
#include "halflit/model.hpp"
#include "halflit/up_axis.hpp"

namespace halflit::cli {
namespace {

Result<LoadedScene> load_file(const RenderOptions& options) {
    LoadOptions load = options.load;
    load.threads = options.execution.threads;
    if (options.scene != "-") return load_model(options.scene, load);
    const auto bytes = read_standard_input(options.load.limits.max_file_bytes, options.load.limits.time_limit_s);
    if (!bytes) return tl::unexpected(bytes.error());
    return load_model_bytes(*bytes, kStandardInputName, "", load);
}

/// Copies of the function share the names.
NameOfInstance node_names(const LoadedScene& loaded) {
    struct NodeNames {
        std::vector<std::string> of_nodes;
        std::vector<int> node_of_instance;
    };
    auto names = std::make_shared<NodeNames>();
    for (const Node& node : loaded.nodes) names->of_nodes.push_back(node.name);
    names->node_of_instance = loaded.node_of_instance;
    return [names](std::size_t instance) -> std::string {
        if (instance >= names->node_of_instance.size()) return "";  // of the program, such as a ground
        return names->of_nodes[static_cast<std::size_t>(names->node_of_instance[instance])];
    };
}

}  // namespace

Result<SceneSource> load_scene(const RenderOptions& options) {
    const std::string name = options.scene.empty() ? "demo" : options.scene;
    auto built_in = built_in_scene(name);
    if (!built_in) return tl::unexpected(built_in.error());
    if (*built_in) {
        turn_upright(**built_in, options.load.up.value_or(UpAxis::y));
        return SceneSource{.name = name, .scene = std::make_unique<Scene>(std::move(**built_in)), .file = std::nullopt, .warnings = {}};
    }
    auto loaded = load_file(options);
    if (!loaded && loaded.error().code == ErrorCode::io && name != "-")
        return fail(ErrorCode::io, loaded.error().message + did_you_mean_file(name, {"demo", "sphere:N", "lights:N"}));
    if (!loaded) return tl::unexpected(loaded.error());
    return SceneSource{name == "-" ? kStandardInputName : name,
                       std::make_unique<Scene>(std::move(loaded->scene)),
                       std::move(loaded->info),
                       std::move(loaded->warnings),
                       std::move(loaded->animations),
                       loaded->animation,
                       std::move(loaded->placement),
                       std::move(loaded->motion),
                       node_names(*loaded)};
}

bool is_scene(const std::string& name) { return name == "-" || is_built_in_name(name) || is_model_name(name) || is_file(name); }

Result<EnvironmentImage> find_environment(const std::string& name) {
    if (name == "sky") return built_in_sky();
    if (name == "studio") return studio_image();
    auto environment = read_environment(name);
    if (!environment && environment.error().code == ErrorCode::io)
        return fail(ErrorCode::io, environment.error().message + did_you_mean_file(name, {"sky", "studio"}));
    return environment;
}

}  // namespace halflit::cli
