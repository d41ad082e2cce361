#include "apps/io/models/obj_strokes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

namespace halflit::io::detail {

void ObjStrokes::add(std::uint32_t part, Topology topology, std::span<const std::uint32_t> corners) {
    std::vector<std::uint32_t>& list = corners_of_[{part, topology}];
    builder_.take_entries<std::uint64_t>(2 * corners.size());
    if (topology == Topology::points) return void(list.insert(list.end(), corners.begin(), corners.end()));
    for (std::size_t i = 1; i < corners.size(); ++i) list.insert(list.end(), {corners[i - 1], corners[i]});
}

int ObjStrokes::unlit(int material) {
    const auto [entry, is_new] = unlit_of_.try_emplace(material, -1);
    if (!is_new) return entry->second;
    Material plain = builder_.loaded().scene.materials[static_cast<std::size_t>(material)];
    plain.unlit = true;
    plain.textures = {};
    return entry->second = builder_.add_material(plain);
}

std::vector<PartMesh> ObjStrokes::add_meshes(std::span<const Vec3d> positions, std::span<const Vec4f> colors,
                                             std::span<const int> material_of, std::span<const std::string> name_of) {
    std::vector<PartMesh> all;
    std::size_t left_out = 0;
    for (auto& [key, corners] : corners_of_) {
        const auto& [part, topology] = key;
        Mesh mesh;
        mesh.topology = topology;
        mesh.name = name_of[part];
        mesh.material = unlit(material_of[part]);
        std::unordered_map<std::uint32_t, std::uint32_t> vertex_of;  // of a position
        std::vector<std::uint32_t> vertices;                         // their positions
        DoubleBox box;
        const std::size_t step = corners_of(topology);
        for (std::size_t i = 0; i + step <= corners.size(); i += step) {
            const std::span<const std::uint32_t> primitive(&corners[i], step);
            if (!std::all_of(primitive.begin(), primitive.end(), [&](std::uint32_t p) { return fits_float(positions[p]); })) {
                ++left_out;
                continue;
            }
            for (const std::uint32_t p : primitive) {
                const auto [entry, is_new] = vertex_of.try_emplace(p, static_cast<std::uint32_t>(vertices.size()));
                if (is_new) {
                    vertices.push_back(p);
                    box.include(positions[p]);
                    if (!colors.empty()) mesh.colors.push_back(p < colors.size() ? colors[p] : Vec4f{1, 1, 1, 1});
                }
                mesh.indices.push_back(entry->second);
            }
        }
        corners = {};
        if (mesh.indices.empty()) continue;
        const Vec3d origin = builder_.options().recentre ? origin_of(box) : Vec3d{};
        for (const std::uint32_t p : vertices) mesh.positions.push_back(rounded_near(positions[p], origin));
        all.push_back({part, builder_.add_mesh(std::move(mesh), origin)});
    }
    if (left_out > 0)
        builder_.document().warn(fmt::format("{} lines or points with coordinates that are not finite are left out", left_out));
    return all;
}

}  // namespace halflit::io::detail
