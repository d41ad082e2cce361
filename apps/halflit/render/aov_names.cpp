#include "apps/halflit/render/aov_names.hpp"

#include "apps/halflit/report/run_report.hpp"
#include "halflit/fragment_planes.hpp"

#include <nlohmann/json.hpp>

#include <numeric>

namespace halflit::cli {
namespace {

/// Names in the order of their numbers.
template <class List>
Json name_list(const List& list) {
    Json names = Json::array();
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
    Json instances = Json::array();
    for (std::size_t i = 0; i < meshes.size(); ++i)
        instances.push_back(
            {{"part", part_number(source, static_cast<std::uint32_t>(i) + 1)}, {"mesh", meshes[i]}, {"material", materials[i]}});
    Json text = report_head("names");
    text["instances"] = std::move(instances);
    text["parts"] = name_list(source.parts->list());
    text["meshes"] = name_list(scene.meshes);
    text["materials"] = name_list(scene.materials);
    return to_text(text);
}

std::string depth16_text(const DepthRange& range) {
    Json text = report_head("depth16");
    text["depth_of_1"] = range.least;
    text["depth_of_65535"] = range.most;
    return to_text(text);
}

}  // namespace halflit::cli
