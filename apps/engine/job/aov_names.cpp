#include "apps/engine/job/aov_names.hpp"

#include "apps/io/files/text.hpp"
#include "halflit/fragment_planes.hpp"

#include <nlohmann/json.hpp>

#include <numeric>

namespace halflit::engine {
namespace {

using Text = nlohmann::ordered_json;

/// Bytes of names that are not UTF-8 are replaced.
std::string lines_of(const Text& text) { return io::display_safe_json(text.dump(2, ' ', false, Text::error_handler_t::replace)) + "\n"; }

/// Names in the order of their numbers.
template <class List>
Text name_list(const List& list) {
    Text names = Text::array();
    for (const auto& one : list) names.push_back(one.name);
    return names;
}

}  // namespace

std::uint32_t part_number(const SceneSource& source, std::uint32_t instance) {
    return instance == 0 ? 0 : static_cast<std::uint32_t>(source.parts->of_instance(instance - 1) + 1);
}

std::string names_text(const SceneSource& source) {
    const Scene& scene = *source.scene;
    std::vector<std::uint32_t> meshes(scene.instances.size());
    std::iota(meshes.begin(), meshes.end(), 1u);
    std::vector<std::uint32_t> materials = meshes;
    make_mesh_numbers(scene, meshes);
    make_material_numbers(scene, materials);
    Text instances = Text::array();
    for (std::size_t i = 0; i < meshes.size(); ++i)
        instances.push_back(
            {{"part", part_number(source, static_cast<std::uint32_t>(i) + 1)}, {"mesh", meshes[i]}, {"material", materials[i]}});
    Text text{{"schema", "halflit.names/1"}};
    text["instances"] = std::move(instances);
    text["parts"] = name_list(source.parts->list());
    text["meshes"] = name_list(scene.meshes);
    text["materials"] = name_list(scene.materials);
    return lines_of(text);
}

std::string depth16_text(const DepthRange& range) {
    Text text{{"schema", "halflit.depth16/1"}};
    text["depth_of_1"] = range.least;
    text["depth_of_65535"] = range.most;
    return lines_of(text);
}

}  // namespace halflit::engine
