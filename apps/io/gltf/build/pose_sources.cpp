#include "apps/io/gltf/build/pose_sources.hpp"

namespace halflit::io::detail {

std::span<const double> weights_of(const file::File& file, std::size_t node) {
    const file::Run own = file.nodes[node].weights;
    if (own.count > 0) return std::span(file.weights).subspan(own.first, own.count);
    return file.meshes[static_cast<std::size_t>(file.nodes[node].mesh)].weights;
}

Mesh without_triangles(const Mesh& mesh) {
    Mesh out;
    out.name = mesh.name;
    out.material = mesh.material;
    out.topology = mesh.topology;
    return out;
}

std::uint64_t bytes_of(const Mesh& mesh) {
    const auto bytes = [](const auto& list) { return std::uint64_t{list.size()} * sizeof list[0]; };
    return bytes(mesh.positions) + bytes(mesh.normals) + bytes(mesh.tangents) + bytes(mesh.uv0) + bytes(mesh.uv1) + bytes(mesh.colors) +
           bytes(mesh.indices);
}

}  // namespace halflit::io::detail
