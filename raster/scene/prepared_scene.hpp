// A scene made ready to draw, once: checked, its meshes cut into clusters, its instances bounded. Frames are drawn from it, and when
// something in the scene changes it is told what, and redoes that alone.
#pragma once

#include "raster/parallel_for.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "raster/scene/scene.hpp"
#include "shading/fragment_block.hpp"
#include "shading/result.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster {

/// What is no longer as it was when a scene was prepared. Numbers of meshes, instances and materials must be the same.
struct SceneChanges {
    std::vector<std::size_t> moved_instances{};  ///< Instance::world_from_object
    std::vector<std::size_t> deformed_meshes{};  ///< any array of the mesh, indices and material included
    bool materials = false;                      ///< materials or textures
    bool lights = false;                         ///< lights, ambient light or environment
};

/// Grow with every change and are never the same for two scenes, so that what was made from a scene can be kept while they stay.
struct SceneRevision {
    std::uint64_t geometry = 0, materials = 0, lights = 0;
    friend bool operator==(const SceneRevision&, const SceneRevision&) = default;
};

/// Refers to the scene that it was made from: that must stay where it is, and changes must be told. Reading is thread-safe.
class PreparedScene {
public:
    /// Fails where the scene is broken: an index out of range, arrays that do not fit together, a lobe that is none.
    static Result<PreparedScene> make(const Scene& scene, const Workers& workers = {});

    /// Takes the time of what changed: microseconds for a moved instance. After an error the scene is not to be drawn.
    Result<void> update(const SceneChanges& changes, const Workers& workers = {});

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const SceneRevision& revision() const { return revision_; }
    /// World-space box of everything drawn; the same as scene_bounds.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] const PreparedMesh& mesh(int index) const { return meshes_[static_cast<std::size_t>(index)]; }
    /// World-space box of each instance.
    [[nodiscard]] std::span<const Bounds> instance_bounds() const { return instance_bounds_; }
    /// Over all instances.
    [[nodiscard]] std::uint64_t triangle_count() const { return triangle_count_; }
    /// The largest magnitude of a texture coordinate, and the largest channel of a vertex colour (at least 1), of what is drawn.
    [[nodiscard]] double largest_uv() const { return largest_uv_; }
    [[nodiscard]] double largest_color() const { return largest_color_; }

    // By material; one more at the end, for meshes that have none.
    /// The union of the vertex data that the material's meshes bring.
    [[nodiscard]] std::span<const shading::SlotMask> available_slots() const { return available_slots_; }
    /// Whether some instance is made of it.
    [[nodiscard]] const std::vector<bool>& drawn_materials() const { return drawn_materials_; }
    [[nodiscard]] std::size_t material_of(const Mesh& mesh) const {
        return mesh.material >= 0 ? static_cast<std::size_t>(mesh.material) : scene_->materials.size();
    }
    /// Of the sphere that fits the box of the largest instance made of the material, world units; 0 where there is none.
    [[nodiscard]] std::span<const double> object_radii() const { return object_radii_; }
    /// What materials that are not there are drawn as.
    [[nodiscard]] const shading::Material& material(std::size_t index) const {
        return index < scene_->materials.size() ? scene_->materials[index] : no_material_;
    }

private:
    PreparedScene() = default;
    Result<void> prepare(std::size_t mesh, Executor& executor);
    Result<void> prepare_meshes(Executor& executor);
    Result<void> check_materials() const;
    void collect();  ///< what is summed up over meshes and instances

    const Scene* scene_ = nullptr;
    SceneRevision revision_;
    std::vector<PreparedMesh> meshes_;
    std::vector<Bounds> instance_bounds_;
    Bounds bounds_;
    std::uint64_t triangle_count_ = 0;
    double largest_uv_ = 0, largest_color_ = 1;
    std::vector<double> object_radii_;
    std::vector<shading::SlotMask> available_slots_;
    std::vector<bool> drawn_materials_;
    shading::Material no_material_;
};

}  // namespace halflit::raster
