#include "raster/scene/prepared_data.hpp"

#include "raster/detail/executor.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_box.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

namespace halflit::raster {
namespace {

std::uint64_t next_revision() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

SceneRevision all_new_revisions() { return {next_revision(), next_revision(), next_revision(), next_revision()}; }

shading::SlotMask slots_of(const Mesh& mesh) {
    shading::SlotMask slots = shading::kBaseSlots;
    if (!mesh.tangents.empty()) slots |= shading::kTangentSlot;
    if (!mesh.colors.empty()) slots |= shading::kColorSlot;
    if (!mesh.uv1.empty()) slots |= shading::kUv1Slot;
    return slots;
}

Result<void> check_material(const Material& material, std::size_t index, std::size_t texture_count) {
    for (const TextureUse& use : material.textures)
        if (use.used() && static_cast<std::size_t>(use.texture) >= texture_count)
            return fail(ErrorCode::bad_input, "material " + std::to_string(index) + ": refers to texture " + std::to_string(use.texture) +
                                                  ", but the scene has " + std::to_string(texture_count));
    if (const auto lobe = check_lobe(material.lobe); !lobe)
        return fail(lobe.error().code, "material " + std::to_string(index) + ": lobe: " + lobe.error().message);
    return {};
}

constexpr double kRootOfThree = 1.7320508075688772;

/// Instances per task that computes boxes.
constexpr std::size_t kInstancesPerTask = 256;

}  // namespace

Result<void> PreparedData::prepare(std::size_t index, Executor& executor) {
    const Mesh& mesh = scene_->meshes[index];
    const auto failed = [&](const Error& error) { return fail(error.code, "mesh " + std::to_string(index) + ": " + error.message); };
    auto prepared = prepare_mesh(mesh, executor);
    if (!prepared) return failed(prepared.error());
    if (mesh.material >= 0 && static_cast<std::size_t>(mesh.material) >= scene_->materials.size())
        return failed({ErrorCode::bad_input, "the material index is out of range"});
    meshes_[index] = std::move(*prepared);
    return {};
}

Result<void> PreparedData::prepare_meshes(std::span<const std::size_t> which, Executor& executor) {
    // Small meshes side by side, each by one task; large ones one after the other, each by all threads. The first fault counts.
    constexpr std::size_t kLargeMesh = 1 << 16;  // indices
    std::vector<Result<void>> results(which.size());
    const auto large = [&](std::size_t mesh) { return scene_->meshes[mesh].indices.size() >= kLargeMesh; };
    executor.run(static_cast<int>(which.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        if (large(which[k])) return;
        Executor alone;
        results[k] = prepare(which[k], alone);
    });
    for (std::size_t k = 0; k < which.size(); ++k) {
        if (large(which[k])) results[k] = prepare(which[k], executor);
        if (!results[k]) return results[k];
    }
    return {};
}

Result<void> PreparedData::check_instance(std::size_t index) const {
    const auto [mesh, ignored, material, color, visible, backdrop] = scene_->instances[index];
    const auto names = [&](const char* what, int named, std::size_t count) {
        return fail(ErrorCode::bad_input,
                    "instance " + std::to_string(index) + " names " + what + " " + std::to_string(named) + " of " + std::to_string(count));
    };
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= scene_->meshes.size()) return names("mesh", mesh, scene_->meshes.size());
    if (material >= 0 && static_cast<std::size_t>(material) >= scene_->materials.size())
        return names("material", material, scene_->materials.size());
    if (!finite(Vec3f{color.x, color.y, color.z}) || !finite(color.w))
        return fail(ErrorCode::bad_input, "instance " + std::to_string(index) + ": its colour is not finite");
    return {};
}

void PreparedData::place(std::size_t index) {
    const Instance& instance = scene_->instances[index];
    if (!instance.visible) {
        instance_bounds_[index] = {};
        return;
    }
    constexpr std::uint64_t kUnitsAVertex = 12;
    charge_work(kUnitsAVertex * source_mesh(instance.mesh).positions.size());
    instance_bounds_[index] = placed_bounds(source_mesh(instance.mesh), mesh(instance.mesh), instance.world_from_object);
}

Result<void> PreparedData::check_materials() const {
    for (std::size_t i = 0; i < scene_->materials.size(); ++i)
        if (auto ok = check_material(scene_->materials[i], i, scene_->textures.size()); !ok) return ok;
    return {};
}

bool PreparedData::note_coverage() {
    decltype(coverage_) coverage;
    bool masks = false;  // they cover what their textures say, which are not compared
    for (std::size_t i = 0; i < material_count(); ++i) {
        const Material& material = this->material(i);
        coverage.emplace_back(material.is_layer() ? AlphaMode::blend : material.alpha_mode, material.double_sided, material.shadow_catcher);
        masks |= material.alpha_mode == AlphaMode::mask;
    }
    const bool same = coverage == coverage_ && !masks;
    coverage_ = std::move(coverage);
    return !same;
}

std::size_t PreparedData::material_index_of(const Instance& instance) const {
    const int index = instance.material >= 0 ? instance.material : source_mesh(instance.mesh).material;
    return index >= 0 ? static_cast<std::size_t>(index) : scene_->materials.size();
}

void PreparedData::find_looks() {
    constexpr Vec4f kWhite{1, 1, 1, 1};
    looks_.clear();
    look_keys_.clear();
    material_of_instance_.clear();
    const std::vector<Instance>& instances = scene_->instances;
    if (std::all_of(instances.begin(), instances.end(), [&](const Instance& instance) { return instance.color == kWhite; })) return;
    std::map<std::tuple<std::size_t, float, float, float, float>, std::uint32_t> known;
    for (const Instance& instance : instances) {
        const std::size_t material = material_index_of(instance);
        const Vec4f c = instance.color;
        if (c == kWhite) {
            material_of_instance_.push_back(static_cast<std::uint32_t>(material));
            continue;
        }
        const auto [entry, is_new] = known.try_emplace({material, c.x, c.y, c.z, c.w}, static_cast<std::uint32_t>(material_count()));
        if (is_new) {
            Material look = this->material(material);
            look.base_color = {look.base_color.x * c.x, look.base_color.y * c.y, look.base_color.z * c.z, look.base_color.w * c.w};
            looks_.push_back(std::move(look));
            look_keys_.emplace_back(material, c);
        }
        material_of_instance_.push_back(entry->second);
    }
}

void PreparedData::collect() {
    bounds_ = {};
    triangle_count_ = 0, has_splats_ = false;
    available_slots_.assign(material_count(), shading::kBaseSlots);
    drawn_materials_.assign(material_count(), false);
    object_radii_.assign(material_count(), 0.0);
    largest_color_ = largest_splat_color_ = 1;
    instances_without_normals_.clear();
    std::set<std::pair<int, std::size_t>> noted;  // mesh and material
    for (const Mesh& mesh : scene_->meshes)
        available_slots_[mesh.material >= 0 ? static_cast<std::size_t>(mesh.material) : scene_->materials.size()] |= slots_of(mesh);
    for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
        const Instance& instance = scene_->instances[i];
        const Mesh& mesh = source_mesh(instance.mesh);
        const std::size_t material = material_of(i);
        available_slots_[material] |= slots_of(mesh);
        has_splats_ |= mesh.splats != nullptr && instance.visible;  // also where views are fitted to none of them
        if (mesh.indices.empty() || !instance.visible) continue;
        bounds_.include(instance_bounds_[i]);
        if (mesh.splats == nullptr) triangle_count_ += raster::triangle_count(mesh);
        drawn_materials_[material] = true;
        const Bounds& box = instance_bounds_[i];
        if (!box.empty) object_radii_[material] = std::max(object_radii_[material], static_cast<double>(box.radius()) / kRootOfThree);
        if (mesh.normals.empty() && noted.emplace(instance.mesh, material).second) instances_without_normals_.push_back(i);
        const PreparedMesh& prepared = this->mesh(instance.mesh);
        largest_color_ = std::max(largest_color_, static_cast<double>(prepared.largest_color));
        largest_splat_color_ = std::max(largest_splat_color_, prepared.largest_splat_color);
    }
    measure_framed();
}

void PreparedData::measure_framed() {
    framed_bounds_ = {};
    for (std::size_t i = 0; i < scene_->instances.size(); ++i)
        if (counts_for_views(*scene_, scene_->instances[i])) framed_bounds_.include(instance_bounds_[i]);
}

const FramedPart& PreparedData::framed_part() const {
    const FpEnvironment environment_of_host;
    const std::lock_guard<std::mutex> lock(part_->finding);
    if (part_->part == nullptr) part_->part = std::make_unique<const FramedPart>(raster::framed_part(*scene_));
    return *part_->part;
}

void PreparedData::find_coplanar(std::span<const std::uint8_t> moved) {
    std::vector<CoplanarPair> found = find_coplanar_pairs(*this, moved);
    std::erase_if(coplanar_pairs_, [&](const CoplanarPair& pair) {
        return moved.empty() || moved[pair.first.instance] != 0 || moved[pair.second.instance] != 0;
    });
    if (found.empty() && coplanar_pairs_.empty() && coplanar_.empty()) return;
    coplanar_pairs_.insert(coplanar_pairs_.end(), found.begin(), found.end());
    std::sort(coplanar_pairs_.begin(), coplanar_pairs_.end());
    coplanar_ = CoplanarGroups(*this, coplanar_pairs_);
}

/// Its meshes alone are prepared.
Result<PreparedData> PreparedData::of_meshes(const Scene& scene, Executor& executor) {
    PreparedData prepared;
    prepared.scene_ = &scene;
    prepared.meshes_.resize(scene.meshes.size());
    std::vector<std::size_t> all(scene.meshes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (auto ok = prepared.prepare_meshes(all, executor); !ok) return tl::unexpected<Error>(ok.error());
    return prepared;
}

Result<PreparedData> PreparedData::make(const Scene& scene, const Execution& execution) {
    return guarded("preparing a scene", execution, [&]() -> Result<PreparedData> {
        const WorkLimit work(scene.frame_work);
        Executor executor;
        executor.configure(execution);
        auto made = of_meshes(scene, executor);
        if (!made) return made;
        PreparedData& prepared = *made;
        if (auto ok = prepared.check_materials(); !ok) return tl::unexpected<Error>(ok.error());
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (auto ok = prepared.check_instance(i); !ok) return tl::unexpected<Error>(ok.error());
        prepared.instance_bounds_.resize(scene.instances.size());
        executor.run(static_cast<int>((scene.instances.size() + kInstancesPerTask - 1) / kInstancesPerTask), [&](int task) {
            const std::size_t begin = static_cast<std::size_t>(task) * kInstancesPerTask;
            for (std::size_t i = begin; i < std::min(begin + kInstancesPerTask, scene.instances.size()); ++i) prepared.place(i);
        });
        prepared.scene_materials_ = scene.materials.size();
        prepared.find_looks();
        prepared.collect();
        prepared.shadow_casters_ = collect_shadow_casters(scene, prepared.meshes_, prepared.instance_bounds_);
        prepared.note_coverage();
        prepared.find_coplanar({});
        prepared.revision_ = all_new_revisions();
        return made;
    });
}

Result<PreparedData> PreparedData::make_for_geometry(const Scene& scene, const Execution& execution) {
    return guarded("preparing a scene", execution, [&]() -> Result<PreparedData> {
        Executor executor;
        executor.configure(execution);
        auto made = of_meshes(scene, executor);
        if (!made) return made;
        PreparedData& prepared = *made;
        if (auto ok = prepared.place_instances(); !ok) return tl::unexpected<Error>(ok.error());
        return made;
    });
}

Result<void> PreparedData::place_instances() {
    instance_bounds_.resize(scene_->instances.size());
    bounds_ = {};
    triangle_count_ = 0;
    for (std::size_t i = 0; i < instance_bounds_.size(); ++i) {
        if (auto ok = check_instance(i); !ok) return ok;
        const Instance& instance = scene_->instances[i];
        instance_bounds_[i] = rough_bounds(mesh(instance.mesh).bounds, instance.world_from_object);
        bounds_.include(instance_bounds_[i]);
        triangle_count_ += raster::triangle_count(source_mesh(instance.mesh));
    }
    revision_ = all_new_revisions();
    return {};
}

Result<void> PreparedData::update(const SceneChanges& changes, const Execution& execution) {
    up_to_date_ = false;
    auto result = guarded("updating a scene", execution, [&]() -> Result<void> {
        const WorkLimit work(scene_->frame_work);
        if (auto ok = note(changes); !ok) return ok;
        return apply_pending(execution);
    });
    if (result) {
        pending_ = {};
        up_to_date_ = true;
    } else {
        revision_ = all_new_revisions();  // nothing made before is used again
    }
    return result;
}

Result<void> PreparedData::note(const SceneChanges& changes) {
    Result<void> result;
    const auto add = [&](const char* what, const std::vector<std::size_t>& told, std::size_t count, std::vector<std::size_t>& to) {
        for (const std::size_t i : told) {
            if (i < count)
                to.push_back(i);
            else
                result =
                    fail(ErrorCode::usage, std::string(what) + " " + std::to_string(i) + " is told to have changed, but the scene had " +
                                               std::to_string(count) + " when it was prepared");
        }
    };
    add("mesh", changes.deformed_meshes, meshes_.size(), pending_.deformed_meshes);
    add("instance", changes.changed_instances, instance_bounds_.size(), pending_.changed_instances);
    pending_.materials |= changes.materials;
    pending_.lights |= changes.lights;
    return result;
}

Result<void> PreparedData::apply_pending(const Execution& execution) {
    const Scene& scene = *scene_;
    if (scene.meshes.size() != meshes_.size() || scene.instances.size() != instance_bounds_.size() ||
        scene.materials.size() != scene_materials_)
        return fail(ErrorCode::usage, "the scene has other numbers of meshes, instances or materials than when it was prepared");
    const bool deformed = !pending_.deformed_meshes.empty();
    if (deformed) {
        Executor executor;
        executor.configure(execution);
        std::vector<std::size_t>& which = pending_.deformed_meshes;
        std::sort(which.begin(), which.end());
        which.erase(std::unique(which.begin(), which.end()), which.end());
        if (auto ok = prepare_meshes(which, executor); !ok) return ok;
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (std::binary_search(which.begin(), which.end(), static_cast<std::size_t>(scene.instances[i].mesh))) place(i);
    }
    const std::vector<bool> drawn_before = drawn_materials_;
    for (const std::size_t i : pending_.changed_instances) {
        if (auto ok = check_instance(i); !ok) return ok;
        place(i);
    }
    if (deformed || pending_.materials)
        if (auto ok = check_materials(); !ok) return ok;
    const auto looks_before = look_keys_;
    const auto coverage_before = coverage_;
    if (deformed || pending_.materials || !pending_.changed_instances.empty()) find_looks();
    const bool other_looks = look_keys_ != looks_before;
    if (deformed || other_looks || !pending_.changed_instances.empty()) {
        collect();
        revision_.geometry = next_revision();
    } else if (pending_.materials) {
        measure_framed();
    }
    // The plan leaves out what no drawn instance needs.
    if (deformed || other_looks || pending_.materials || drawn_materials_ != drawn_before) {
        revision_.materials = next_revision();
        if (note_coverage()) revision_.coverage = next_revision();
    }
    if (deformed || pending_.materials || !pending_.changed_instances.empty())
        shadow_casters_ = collect_shadow_casters(scene, meshes_, instance_bounds_);
    if (other_looks || coverage_ != coverage_before) {
        find_coplanar({});
    } else if (deformed || !pending_.changed_instances.empty()) {
        std::vector<std::uint8_t> moved(scene.instances.size());
        for (const std::size_t i : pending_.changed_instances) moved[i] = 1;
        for (std::size_t i = 0; deformed && i < moved.size(); ++i)
            moved[i] |= std::binary_search(pending_.deformed_meshes.begin(), pending_.deformed_meshes.end(),
                                           static_cast<std::size_t>(scene.instances[i].mesh));
        find_coplanar(moved);
    }
    if (pending_.lights) revision_.lights = next_revision();
    if (deformed || pending_.materials || !pending_.changed_instances.empty()) part_->part.reset();
    return {};
}

}  // namespace halflit::raster
