#include "tests/fuzz/loading.hpp"

#include "shading/material_properties.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::fuzz {
namespace {

bool in_range(int index, std::size_t count) { return index >= -1 && index < static_cast<int>(count); }

void check_mesh(const Mesh& mesh, const Scene& scene) {
    const std::size_t n = mesh.positions.size();
    const auto fits = [n](const auto& values) { return values.empty() || values.size() == n; };
    HALFLIT_PROMISE(fits(mesh.normals) && fits(mesh.tangents) && fits(mesh.uv0) && fits(mesh.uv1) && fits(mesh.colors));
    HALFLIT_PROMISE(mesh.indices.size() % corners_of(mesh.topology) == 0);
    for (const std::uint32_t index : mesh.indices) HALFLIT_PROMISE(index < n);
    HALFLIT_PROMISE(in_range(mesh.material, scene.materials.size()));
}

bool is_plain(const std::string& text) {
    return std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

}  // namespace

void check_loaded(const LoadedScene& loaded) {
    const Scene& scene = loaded.scene;
    for (const Mesh& mesh : scene.meshes) check_mesh(mesh, scene);
    for (const Instance& instance : scene.instances)
        HALFLIT_PROMISE(instance.mesh >= 0 && instance.mesh < static_cast<int>(scene.meshes.size()));
    for (const Material& m : scene.materials) {
        for (const TextureUse& use : m.textures)
            HALFLIT_PROMISE(in_range(use.texture, scene.textures.size()) && (use.uv_set == 0 || use.uv_set == 1));
        for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
            float values[4];
            number.get(m, values);
            for (int c = 0; c < number.count; ++c) HALFLIT_PROMISE(values[c] >= number.low && values[c] <= number.high);
        }
        HALFLIT_PROMISE(check_lobe(m.lobe).has_value());
    }
    for (const Node& node : loaded.nodes) {
        HALFLIT_PROMISE(in_range(node.parent, loaded.nodes.size()));
        HALFLIT_PROMISE(in_range(node.camera, scene.cameras.size()) && in_range(node.light, scene.lights.size()));
        for (const int instance : node.instances) HALFLIT_PROMISE(instance >= 0 && instance < static_cast<int>(scene.instances.size()));
    }
    for (const std::string& warning : loaded.warnings) HALFLIT_PROMISE(is_plain(warning));
    Scene posed = scene;
    HALFLIT_PROMISE(pose(loaded.nodes, posed, loaded.placement).has_value());
    for (std::size_t i = 0; i < posed.instances.size(); ++i)  // nodes as loaded give the same bits
        HALFLIT_PROMISE(std::memcmp(&posed.instances[i].world_from_object, &scene.instances[i].world_from_object, sizeof(Mat4)) == 0);
    if (loaded.motion == nullptr) return;
    for (const double time : {1e9, 0.7, -1.0}) {
        HALFLIT_PROMISE(pose_at(*loaded.motion, "", time, posed).has_value());
        for (const Mesh& mesh : posed.meshes) check_mesh(mesh, posed);
    }
    HALFLIT_PROMISE(pose_at(*loaded.motion, "none", 0.0, posed).has_value());
    HALFLIT_PROMISE(pose_at(*loaded.motion, "", 0.0, posed).has_value());  // the pose that was loaded: the same bits again
    for (std::size_t i = 0; i < posed.instances.size(); ++i)
        HALFLIT_PROMISE(std::memcmp(&posed.instances[i].world_from_object, &scene.instances[i].world_from_object, sizeof(Mat4)) == 0);
    for (std::size_t i = 0; i < posed.meshes.size(); ++i) {
        const auto &a = posed.meshes[i].positions, &b = scene.meshes[i].positions;
        HALFLIT_PROMISE(a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0));
    }
}

void check_error(const Error& error) {
    HALFLIT_PROMISE(error.code == ErrorCode::bad_input || error.code == ErrorCode::limit);
    HALFLIT_PROMISE(!error.message.empty() && is_plain(error.message));
}

}  // namespace halflit::fuzz
