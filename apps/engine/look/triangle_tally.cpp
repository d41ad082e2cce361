#include "apps/engine/look/triangle_tally.hpp"

namespace halflit::engine {

TriangleNumbers::TriangleNumbers(const Scene& scene) {
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        first.push_back(count);
        has_triangles.push_back(mesh.topology == Topology::triangles);
        count += triangles_of(mesh);
    }
}

std::vector<SeenTriangle> TriangleTally::count(const ViewShot& shot) {
    std::vector<SeenTriangle> seen;
    const std::size_t size = shot.instance.size();
    const std::uint32_t *const instances = shot.instance.data(), *const triangles = shot.triangle.data();
    for (std::size_t i = 0; i < size;) {
        // Neighbours mostly show one triangle.
        const std::uint32_t instance = instances[i], triangle = triangles[i];
        std::size_t end = i + 1;
        while (end < size && triangles[end] == triangle && instances[end] == instance) ++end;
        const auto pixels = static_cast<std::int32_t>(end - i);
        i = end;
        if (instance == 0 || !numbers_.has_triangles[instance - 1]) continue;
        const std::size_t number = numbers_.first[instance - 1] + triangle - 1;
        if (pixels_[number] == 0) seen.push_back({static_cast<std::uint32_t>(number), 0});
        pixels_[number] += pixels;
    }
    for (SeenTriangle& one : seen) {
        one.pixels = pixels_[one.triangle];
        pixels_[one.triangle] = 0;
    }
    return seen;
}

}  // namespace halflit::engine
