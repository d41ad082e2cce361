// Contents of halflit::PreparedScene: the meshes' clusters, the instances' boxes, and sums over the scene.
#pragma once

#include "halflit/error.hpp"
#include "halflit/prepared_scene.hpp"
#include "halflit/scene.hpp"
#include "raster/scene/coplanar.hpp"
#include "raster/scene/framed_part.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "raster/scene/shadow_casters.hpp"
#include "shading/fragment_block.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace halflit::raster {

/// Revision numbers. They grow with every change and differ between scenes: results made from a scene are valid while they are equal.
struct SceneRevision {
    std::uint64_t geometry = 0, materials = 0, lights = 0;
    std::uint64_t coverage = 0;  ///< changes with the materials' sides, alpha modes and masks, but not with their colours
    friend bool operator==(const SceneRevision&, const SceneRevision&) = default;
};

/// Refers to the scene that it was made from: that must stay at its address, and update() must be told its changes. Reading is thread-safe.
class PreparedData {
public:
    /// Fails for a faulty scene: an index out of range, arrays of different lengths, an invalid lobe.
    [[nodiscard]] static Result<PreparedData> make(const Scene& scene, const Execution& execution = {});

    /// Prepares what geometry passes alone need: boxes may be larger than what they hold, and there are no looks of instances, casters,
    /// coplanar surfaces and framed part. Instances may be others from frame to frame, in number too: place_instances() then.
    [[nodiscard]] static Result<PreparedData> make_for_geometry(const Scene& scene, const Execution& execution = {});
    [[nodiscard]] Result<void> place_instances();
    /// A mesh of a scene so prepared has other positions.
    [[nodiscard]] Result<void> deform(std::size_t mesh, Executor& executor) { return prepare(mesh, executor); }

    /// Redoes what changed, and sums over all instances: 0.03 ms for one of 1,000 moved instances, 14 ms for one of a million. After an
    /// error no frame is drawn until an update succeeds; that one also redoes what the failed ones were told.
    [[nodiscard]] Result<void> update(const SceneChanges& changes, const Execution& execution = {});

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    /// The scene's mesh, or PreparedMesh::unshared.
    [[nodiscard]] const Mesh& source_mesh(int index) const {
        const std::shared_ptr<const Mesh>& unshared = mesh(index).unshared;
        return unshared ? *unshared : scene_->meshes[static_cast<std::size_t>(index)];
    }
    [[nodiscard]] const SceneRevision& revision() const { return revision_; }
    /// False after an update that failed.
    [[nodiscard]] bool up_to_date() const { return up_to_date_; }
    /// World-space box of everything drawn.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// What views look at; the same as scene_bounds().
    [[nodiscard]] const Bounds& framed_bounds() const { return framed_bounds_; }
    /// The part of the scene that views of the whole are fitted to, found by the first call.
    [[nodiscard]] const FramedPart& framed_part() const;
    [[nodiscard]] const PreparedMesh& mesh(int index) const { return meshes_[static_cast<std::size_t>(index)]; }
    /// World-space box of each instance.
    [[nodiscard]] std::span<const Bounds> instance_bounds() const { return instance_bounds_; }
    [[nodiscard]] const ShadowCasters& shadow_casters() const { return shadow_casters_; }
    [[nodiscard]] const CoplanarGroups& coplanar() const { return coplanar_; }
    /// Number of triangles over all instances.
    [[nodiscard]] std::uint64_t triangle_count() const { return triangle_count_; }
    /// True if some instance that is drawn is made of splats.
    [[nodiscard]] bool has_splats() const { return has_splats_; }
    /// The largest channel of a vertex colour of what is drawn, at least 1.
    [[nodiscard]] double largest_color() const { return largest_color_; }
    /// The same of splats.
    [[nodiscard]] double largest_splat_color() const { return largest_splat_color_; }

    // Indexed by material: those of the scene, one for meshes without a material, and looks().
    /// Union of the attribute slots of the meshes that are drawn with the material.
    [[nodiscard]] std::span<const shading::SlotMask> available_slots() const { return available_slots_; }
    /// True if some instance with triangles has the material.
    [[nodiscard]] const std::vector<bool>& drawn_materials() const { return drawn_materials_; }
    /// Materials in the colours of instances.
    [[nodiscard]] std::span<const Material> looks() const { return looks_; }
    [[nodiscard]] std::size_t material_of(std::size_t instance) const {
        return material_of_instance_.empty() ? material_index_of(scene_->instances[instance]) : material_of_instance_[instance];
    }
    /// Drawn instances whose mesh has no normals, the first of each mesh and material.
    [[nodiscard]] std::span<const std::size_t> instances_without_normals() const { return instances_without_normals_; }
    /// Half the diagonal of the box of the largest instance with the material, over sqrt(3): for a sphere its radius. World units; 0 if
    /// there is no instance.
    [[nodiscard]] std::span<const double> object_radii() const { return object_radii_; }
    [[nodiscard]] const Material& material(std::size_t index) const {
        const std::size_t count = scene_->materials.size();
        return index < count ? scene_->materials[index] : index == count ? no_material_ : looks_[index - count - 1];
    }

private:
    PreparedData() = default;
    [[nodiscard]] static Result<PreparedData> of_meshes(const Scene& scene, Executor& executor);
    Result<void> prepare(std::size_t mesh, Executor& executor);
    Result<void> prepare_meshes(std::span<const std::size_t> which, Executor& executor);
    Result<void> check_instance(std::size_t index) const;
    Result<void> check_materials() const;
    bool note_coverage();                            ///< returns true if it may differ from the last call's
    void place(std::size_t instance);                ///< finds its box
    Result<void> note(const SceneChanges& changes);  ///< adds them to pending_
    Result<void> apply_pending(const Execution& execution);
    void collect();  ///< sums over meshes and instances
    void measure_framed();
    void find_looks();  ///< materials of instances that have a colour
    /// moved: instances whose pairs are searched anew; empty: all.
    void find_coplanar(std::span<const std::uint8_t> moved);
    [[nodiscard]] std::size_t material_count() const { return scene_->materials.size() + 1 + looks_.size(); }
    [[nodiscard]] std::size_t material_index_of(const Instance& instance) const;

    struct KeptPart {
        std::mutex finding;
        std::unique_ptr<const FramedPart> part;
    };

    const Scene* scene_ = nullptr;
    std::unique_ptr<KeptPart> part_ = std::make_unique<KeptPart>();
    SceneRevision revision_;
    SceneChanges pending_;  ///< told, and not yet applied
    bool up_to_date_ = true;
    std::vector<PreparedMesh> meshes_;
    std::vector<Bounds> instance_bounds_;
    Bounds framed_bounds_;
    Bounds bounds_;
    ShadowCasters shadow_casters_;
    std::vector<CoplanarPair> coplanar_pairs_;
    CoplanarGroups coplanar_;
    std::uint64_t triangle_count_ = 0;
    bool has_splats_ = false;
    double largest_color_ = 1, largest_splat_color_ = 1;
    std::vector<double> object_radii_;
    std::vector<shading::SlotMask> available_slots_;
    std::vector<bool> drawn_materials_;
    std::vector<std::size_t> instances_without_normals_;
    std::vector<Material> looks_;
    std::vector<std::uint32_t> material_of_instance_;       ///< empty: no instance has a colour
    std::vector<std::pair<std::size_t, Vec4f>> look_keys_;  ///< material and colour of each look
    std::size_t scene_materials_ = 0;                       ///< their number when the scene was prepared
    /// Of each material: alpha mode, whether both sides are drawn, and whether it is a shadow catcher.
    std::vector<std::tuple<AlphaMode, bool, bool>> coverage_;
    Material no_material_;
};

}  // namespace halflit::raster
