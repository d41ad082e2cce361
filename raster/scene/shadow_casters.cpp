#include "raster/scene/shadow_casters.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

/// World axis that each object axis lies along, and its direction there.
struct AxisMap {
    int axis[3] = {0, 1, 2};
    bool flipped[3] = {};
};

/// Returns false unless each object axis lies along a world axis, but for 1e-6.
bool find_axes(const Mat4& m, AxisMap& map) {
    bool taken[3] = {};
    for (int k = 0; k < 3; ++k) {
        const Vec3f c{m.c[k].x, m.c[k].y, m.c[k].z};
        const double size = std::max({magnitude(c.x), magnitude(c.y), magnitude(c.z)});
        int along = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (magnitude(component(c, axis)) <= 1e-6 * size) continue;
            if (along >= 0) return false;
            along = axis;
        }
        if (along < 0 || taken[along]) return false;
        taken[along] = true;
        map.axis[k] = along;
        map.flipped[k] = component(c, along) < 0.0f;
    }
    return true;
}

Bounds placed(const Bounds& box, const Mat4& m) {
    Bounds out;
    if (box.empty) return out;
    out.add(transform_point(m, box.min));
    out.add(transform_point(m, box.max));
    return out;
}

bool casts_no_shadow(const Scene& scene, const Instance& instance) {
    const Material* const material = material_of(scene, instance);
    return material != nullptr && material->is_layer();
}

}  // namespace

std::vector<Bounds> ShadowCasters::of_light(Vec3d place, bool directional) const {
    std::vector<Bounds> boxes;
    if (!rest.empty) boxes.push_back(rest);
    const double at[3] = {place.x, place.y, place.z};
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            const Bounds& face = faces[face_of(axis, high)];
            if (face.empty) continue;
            const double end = directional ? 0.0 : double{component(high ? flats.max : flats.min, axis)};
            const double inwards = high ? end - at[axis] : at[axis] - end;
            if (!(inwards > (directional ? 1e-6 : double{slack}))) boxes.push_back(face);
        }
    return boxes;
}

ShadowCasters collect_shadow_casters(const Scene& scene, std::span<const PreparedMesh> meshes, std::span<const Bounds> boxes) {
    /// f(instance, its mesh, its box, where its axes lie); the last is null if it has no faces across the world's axes.
    const auto each_instance = [&](const auto& f) {
        for (std::size_t i = 0; i < scene.instances.size(); ++i) {
            const Instance& instance = scene.instances[i];
            const PreparedMesh& mesh = meshes[static_cast<std::size_t>(instance.mesh)];
            if (boxes[i].empty || mesh.cluster_count() == 0 || catches_shadows(scene, instance)) continue;
            if (scene.meshes[static_cast<std::size_t>(instance.mesh)].topology != Topology::triangles) continue;
            AxisMap map;
            f(instance, mesh.faces, boxes[i], !mesh.faces.flats.empty && find_axes(instance.world_from_object, map) ? &map : nullptr);
        }
    };
    ShadowCasters out;
    each_instance([&](const Instance& instance, const FlatFaces& faces, const Bounds&, const AxisMap* map) {
        if (map != nullptr) out.flats.include(placed(faces.flats, instance.world_from_object));
    });
    out.slack = face_slack(out.flats);
    each_instance([&](const Instance& instance, const FlatFaces& faces, const Bounds& box, const AxisMap* map) {
        if (map == nullptr) {
            out.rest.include(box);
            return;
        }
        out.rest.include(placed(faces.rest, instance.world_from_object));
        if (casts_no_shadow(scene, instance)) return;
        for (int k = 0; k < 3; ++k)
            for (const bool high_in_object : {false, true}) {
                const Bounds face = placed(faces.faces[face_of(k, high_in_object)], instance.world_from_object);
                if (face.empty) continue;
                const int axis = map->axis[k];
                const bool high = high_in_object != map->flipped[k];
                const float off = high ? component(out.flats.max, axis) - component(face.max, axis)
                                       : component(face.min, axis) - component(out.flats.min, axis);
                (off <= out.slack ? out.faces[face_of(axis, high)] : out.rest).include(face);
            }
    });
    return out;
}

}  // namespace halflit::raster
