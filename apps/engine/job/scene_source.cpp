#include "apps/engine/job/scene_source.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/built_in_scenes.hpp"
#include "apps/io/files/text.hpp"
#include "halflit/model.hpp"
#include "halflit/up_axis.hpp"

namespace halflit::engine {
namespace {

Result<LoadedScene> load_file(const ModelRequest& model) {
    if (model.scene != "-") return load_model(model.scene, model.load);
    return load_model_bytes(*model.input, kStandardInputName, "", model.load);
}

bool is_address(const std::string& name) {
    const std::string scheme = name.substr(0, name.find("://"));
    return scheme.size() < name.size() &&
           (io::same_word(scheme, "http") || io::same_word(scheme, "https") || io::same_word(scheme, "file"));
}

/// Text to type in place of an address.
std::string instead_of(const std::string& address) {
    constexpr std::size_t kHost = 7;  // behind file://
    if (!io::same_word(address.substr(0, kHost), "file://"))
        return ", and no network is used; curl -L '" + address + "' | halflit - -o picture.png";
    const std::size_t slash = address.find('/', kHost);
    return "; expected the file's path: " + address.substr(slash == address.npos ? kHost : slash);
}

}  // namespace

ShownUnit file_unit(const SceneSource& source) {
    constexpr std::pair<double, const char*> kUnits[] = {{1e-6, "um"}, {1e-3, "mm"}, {1e-2, "cm"}, {0.0254, "in"}, {0.3048, "ft"}};
    const double metres = source.file ? source.file->unit_m : 0.0;
    for (const auto& [size, name] : kUnits)
        if (metres == size) return {name, 1.0 / source.placement.scale};
    return {metres > 0 ? "m" : "", 1.0 / source.placement.scale};
}

Result<SceneSource> load_scene(const ModelRequest& model) {
    const std::string name = model.scene.empty() ? "demo" : model.scene;
    auto built_in = built_in_scene(name);
    if (!built_in) return tl::unexpected(built_in.error());
    if (*built_in) {
        const UpAxis up = model.load.up.value_or(UpAxis::y);
        turn_upright(**built_in, up);
        auto scene = std::make_shared<Scene>(std::move(**built_in));
        auto parts = std::make_shared<Parts>(*scene);
        return SceneSource{.name = name,
                           .scene = std::move(scene),
                           .file = std::nullopt,
                           .warnings = {},
                           .placement = {.up = up},
                           .parts = std::move(parts)};
    }
    if (is_address(name)) return fail(ErrorCode::usage, name + ": is an address" + instead_of(name));
    auto loaded = load_file(model);
    if (!loaded && loaded.error().code == ErrorCode::io && name != "-")
        return fail(ErrorCode::io, loaded.error().message + did_you_mean_file(name, {"demo", "sphere:N", "lights:N"}));
    if (!loaded) return tl::unexpected(loaded.error());
    auto parts = std::make_shared<Parts>(*loaded);
    return SceneSource{name == "-" ? kStandardInputName : name,
                       std::make_shared<Scene>(std::move(loaded->scene)),
                       std::move(loaded->info),
                       std::move(loaded->warnings),
                       std::move(loaded->animations),
                       loaded->animation,
                       std::move(loaded->placement),
                       std::move(loaded->motion),
                       std::move(parts)};
}

bool is_scene(const std::string& name) {
    return name == "-" || is_address(name) || is_built_in_name(name) || is_model_name(name) || is_file(name);
}

Result<EnvironmentImage> find_environment(const std::string& name) {
    if (name == "sky") return built_in_sky();
    if (name == "studio") return studio_image();
    auto environment = read_environment(name);
    if (environment || environment.error().code != ErrorCode::io) return environment;
    const std::string meant = did_you_mean_file(name, {"sky", "studio"});
    return fail(ErrorCode::io,
                environment.error().message + (meant.empty() ? "; expected a picture of floats (.hdr, .exr, .pfm), sky or studio" : meant));
}

}  // namespace halflit::engine
