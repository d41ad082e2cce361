#include "raster/scene/prepared_scene.hpp"

#include "raster/detail/executor.hpp"
#include "raster/detail/fp_environment.hpp"

#include <algorithm>
#include <atomic>
#include <string>

namespace halflit::raster {
namespace {

std::uint64_t next_revision() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

shading::SlotMask slots_of(const Mesh& mesh) {
    shading::SlotMask slots = shading::kPositionSlots;
    if (!mesh.tangents.empty()) slots |= shading::kTangentSlot;
    if (!mesh.colors.empty()) slots |= shading::kColorSlot;
    if (!mesh.uv1.empty()) slots |= shading::kUv1Slot;
    return slots;
}

Result<void> check_material(const shading::Material& material, std::size_t index, std::size_t texture_count) {
    for (const shading::TextureUse* use : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                                           &material.occlusion_texture, &material.emissive_texture})
        if (use->used() && static_cast<std::size_t>(use->texture) >= texture_count)
            return fail(ErrorCode::bad_input, "material " + std::to_string(index) + ": refers to texture " + std::to_string(use->texture) +
                                                  ", but the scene has " + std::to_string(texture_count));
    if (const auto lobe = shading::check_lobe(material.lobe); !lobe)
        return fail(lobe.error().code, "material " + std::to_string(index) + ": lobe: " + lobe.error().message);
    return {};
}

constexpr double kRootOfThree = 1.7320508075688772;

/// Instances per task that computes boxes.
constexpr std::size_t kInstancesPerTask = 256;

}  // namespace

Result<void> PreparedScene::prepare(std::size_t index, Executor& executor) {
    const Mesh& mesh = scene_->meshes[index];
    const auto failed = [&](const Error& error) { return fail(error.code, "mesh " + std::to_string(index) + ": " + error.message); };
    auto prepared = prepare_mesh(mesh, executor);
    if (!prepared) return failed(prepared.error());
    if (mesh.material >= 0 && static_cast<std::size_t>(mesh.material) >= scene_->materials.size())
        return failed({ErrorCode::bad_input, "the material index is out of range"});
    meshes_[index] = std::move(*prepared);
    return {};
}

Result<void> PreparedScene::prepare_meshes(Executor& executor) {
    // Small meshes in parallel, one task each; large ones one after the other, each by all threads. The first faulty mesh gives the error.
    constexpr std::size_t kLargeMesh = 1 << 16;  // indices
    std::vector<Result<void>> results(meshes_.size());
    const auto large = [&](std::size_t i) { return scene_->meshes[i].indices.size() >= kLargeMesh; };
    executor.run(static_cast<int>(meshes_.size()), [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        if (large(index)) return;
        Executor alone;
        results[index] = prepare(index, alone);
    });
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (large(i)) results[i] = prepare(i, executor);
        if (!results[i]) return results[i];
    }
    return {};
}

Result<void> PreparedScene::check_materials() const {
    for (std::size_t i = 0; i < scene_->materials.size(); ++i)
        if (auto ok = check_material(scene_->materials[i], i, scene_->textures.size()); !ok) return ok;
    return {};
}

void PreparedScene::collect() {
    bounds_ = {};
    triangle_count_ = 0;
    available_slots_.assign(scene_->materials.size() + 1, shading::kPositionSlots);
    drawn_materials_.assign(scene_->materials.size() + 1, false);
    object_radii_.assign(scene_->materials.size() + 1, 0.0);
    largest_uv_ = 0;
    largest_color_ = 1;
    for (const Mesh& mesh : scene_->meshes) available_slots_[material_of(mesh)] |= slots_of(mesh);
    for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
        const Mesh& mesh = scene_->meshes[static_cast<std::size_t>(scene_->instances[i].mesh)];
        if (mesh.indices.empty()) continue;
        bounds_.include(instance_bounds_[i]);
        triangle_count_ += mesh.indices.size() / 3;
        const std::size_t material = material_of(mesh);
        drawn_materials_[material] = true;
        const Bounds& box = instance_bounds_[i];
        if (!box.empty) object_radii_[material] = std::max(object_radii_[material], static_cast<double>(box.radius()) / kRootOfThree);
        const PreparedMesh& prepared = meshes_[static_cast<std::size_t>(scene_->instances[i].mesh)];
        largest_uv_ = std::max(largest_uv_, static_cast<double>(prepared.largest_uv));
        largest_color_ = std::max(largest_color_, static_cast<double>(prepared.largest_color));
    }
}

Result<PreparedScene> PreparedScene::make(const Scene& scene, const Workers& workers) {
    const FpEnvironment environment;
    Executor executor;
    executor.configure(workers.threads, workers.parallel_for);
    PreparedScene prepared;
    prepared.scene_ = &scene;
    prepared.meshes_.resize(scene.meshes.size());
    if (auto ok = prepared.prepare_meshes(executor); !ok) return tl::unexpected<Error>(ok.error());
    if (auto ok = prepared.check_materials(); !ok) return tl::unexpected<Error>(ok.error());
    for (const Instance& instance : scene.instances)
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size())
            return fail(ErrorCode::bad_input, "an instance refers to mesh " + std::to_string(instance.mesh) + ", but the scene has " +
                                                  std::to_string(scene.meshes.size()));
    prepared.instance_bounds_.resize(scene.instances.size());
    executor.run(static_cast<int>((scene.instances.size() + kInstancesPerTask - 1) / kInstancesPerTask), [&](int task) {
        const std::size_t begin = static_cast<std::size_t>(task) * kInstancesPerTask;
        for (std::size_t i = begin; i < std::min(begin + kInstancesPerTask, scene.instances.size()); ++i) {
            const Instance& instance = scene.instances[i];
            prepared.instance_bounds_[i] = placed_bounds(scene.meshes[static_cast<std::size_t>(instance.mesh)],
                                                         prepared.mesh(instance.mesh), instance.world_from_object);
        }
    });
    prepared.collect();
    prepared.revision_ = {next_revision(), next_revision(), next_revision()};
    return prepared;
}

Result<void> PreparedScene::update(const SceneChanges& changes, const Workers& workers) {
    const FpEnvironment environment;
    const Scene& scene = *scene_;
    if (scene.meshes.size() != meshes_.size() || scene.instances.size() != instance_bounds_.size() ||
        scene.materials.size() + 1 != drawn_materials_.size())
        return fail(ErrorCode::usage, "the number of meshes, instances or materials has changed since the scene was prepared");
    const auto place = [&](std::size_t i) {
        const Instance& instance = scene.instances[i];
        instance_bounds_[i] =
            placed_bounds(scene.meshes[static_cast<std::size_t>(instance.mesh)], mesh(instance.mesh), instance.world_from_object);
    };
    if (!changes.deformed_meshes.empty()) {
        Executor executor;
        executor.configure(workers.threads, workers.parallel_for);
        std::vector<bool> deformed(scene.meshes.size(), false);
        for (const std::size_t i : changes.deformed_meshes) {
            if (i >= scene.meshes.size())
                return fail(ErrorCode::usage,
                            "deformed mesh " + std::to_string(i) + ", but the scene has " + std::to_string(scene.meshes.size()));
            if (auto ok = prepare(i, executor); !ok) return ok;
            deformed[i] = true;
        }
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (deformed[static_cast<std::size_t>(scene.instances[i].mesh)]) place(i);
    }
    for (const std::size_t i : changes.moved_instances) {
        if (i >= scene.instances.size())
            return fail(ErrorCode::usage,
                        "moved instance " + std::to_string(i) + ", but the scene has " + std::to_string(scene.instances.size()));
        place(i);
    }
    if (!changes.deformed_meshes.empty() || !changes.moved_instances.empty()) {
        collect();
        revision_.geometry = next_revision();
    }
    if (changes.materials || !changes.deformed_meshes.empty()) {
        if (auto ok = check_materials(); !ok) return ok;
        revision_.materials = next_revision();
    }
    if (changes.lights) revision_.lights = next_revision();
    return {};
}

}  // namespace halflit::raster
