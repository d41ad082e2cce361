#include "apps/engine/request/classic_material.hpp"

#include "shading/model/scalar.hpp"

#include <algorithm>

namespace halflit::engine {

void replace_materials(Scene& scene, const ClassicMaterial& classic) {
    const auto& [diffuse, specular, exponent] = classic;
    if (!diffuse && !specular && !exponent) return;
    const auto plain = [](const Mesh& mesh) { return mesh.material < 0; };
    if (std::any_of(scene.meshes.begin(), scene.meshes.end(), plain)) {
        const int index = static_cast<int>(scene.materials.size());
        scene.materials.emplace_back();
        for (Mesh& mesh : scene.meshes)
            if (plain(mesh)) mesh.material = index;
    }
    for (Material& material : scene.materials) {
        if (material.unlit) continue;
        material.metallic = 0;
        const float kd = diffuse.value_or(1.0f);
        Vec4f& color = material.base_color;
        color = {kd * color.x, kd * color.y, kd * color.z, color.w};
        material.dielectric_reflectance = specular.value_or(material.dielectric_reflectance);
        if (!exponent) continue;
        material.roughness = static_cast<float>(shading::roughness_of_exponent(static_cast<double>(*exponent)));
        material.textures[TextureSlot::metallic_roughness] = {};
    }
}

}  // namespace halflit::engine
