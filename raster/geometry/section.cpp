#include "halflit/section.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/geometry/section_cap.hpp"
#include "raster/geometry/section_hatch.hpp"
#include "raster/geometry/section_mesh.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace halflit {
namespace {

using raster::CapMesh;
using raster::Left;
using raster::MeshCut;
using raster::PlaneSection;
using raster::UnitPlane;

std::string numbered(const char* what, std::size_t i) { return std::string(what) + " " + std::to_string(i); }

Result<void> check_cut(const Scene& scene, std::span<const CutPlane> planes, const SectionSettings& settings, std::span<const int> parts) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double size = length(planes[i].normal);
        if (!(size > 1e-100) || !(size < 1e100) || !shading::finite(planes[i].offset / size))
            return fail(ErrorCode::usage, numbered("plane", i) + ": expected a finite offset and a finite normal longer than 0");
    }
    if (!(settings.hatch_spacing >= 0.0) || !shading::finite(settings.hatch_spacing))
        return fail(ErrorCode::usage, "hatch_spacing: expected a finite number from 0");
    if (!parts.empty() && parts.size() != scene.instances.size())
        return fail(ErrorCode::usage, "part_of_instance: expected " + std::to_string(scene.instances.size()) + " numbers, found " +
                                          std::to_string(parts.size()));
    for (const int part : parts)
        if (part < 0) return fail(ErrorCode::usage, "part_of_instance: expected numbers from 0, found " + std::to_string(part));
    return {};
}

bool has_sound_arrays(const Mesh& mesh) {
    const std::size_t n = mesh.positions.size();
    for (const std::size_t size : {mesh.normals.size(), mesh.tangents.size(), mesh.uv0.size(), mesh.uv1.size(), mesh.colors.size()})
        if (size != 0 && size != n) return false;
    TimeCheck check;
    return std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) {
        check();
        return i < n;
    });
}

/// Cuts a scene. Nothing of it changes before commit().
class SceneCutter {
public:
    SceneCutter(const Scene& scene, std::span<const CutPlane> planes, std::span<const int> parts)
        : scene_(scene), parts_(parts), bounds_(scene_bounds(scene)), mesh_bounds_(scene.meshes.size()) {
        double largest = 0.0;
        if (!bounds_.empty)
            for (const Vec3f& corner : {bounds_.min, bounds_.max}) {
                const Vec3d size = absolute(to_double(corner));
                largest = std::max({largest, size.x, size.y, size.z});
            }
        // Vertices that were cut by the same plane before are off it by the rounding of three coordinates to float.
        const double tolerance = largest * 0x1p-22;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const double size = length(planes[i].normal);
            const UnitPlane plane{planes[i].normal * (1.0 / size), planes[i].offset / size, tolerance};
            const bool is_new = std::none_of(planes_.begin(), planes_.end(), [&](const UnitPlane& other) {
                return length(other.normal - plane.normal) < 1e-12 && absolute(other.offset - plane.offset) <= tolerance;
            });
            if (!is_new) continue;
            planes_.push_back(plane);
            given_.push_back(i);
        }
    }

    Result<void> cut_instances() {
        for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene_.meshes.size()) continue;
            const int part = part_of(i);
            ordinals_.try_emplace(part, 0);
            if (!raster::counts_for_views(scene_, instance)) continue;
            if (const auto cut = cut_instance(i, part); !cut) return cut;
        }
        int ordinal = 0;
        for (auto& [part, number] : ordinals_) number = ordinal++;
        return {};
    }

    void make_caps(const SectionSettings& settings) {
        double spacing = settings.hatch_spacing;
        if (spacing == 0.0) spacing = static_cast<double>(bounds_.radius()) * (2.0 / 40.0);
        for (auto& [key, section] : sections_) {
            const auto [plane, part] = key;
            CapMesh cap = raster::make_cap(section, planes_, plane, raster::hatch_scale(spacing > 0.0 ? spacing : 1.0, ordinals_[part]));
            if (!(cap.filled_area > 0.0) && cap.open_ends == 0 && !cap.too_complex) continue;
            report_.cuts.push_back({given_[plane], part, section.instance, -1, cap.area, cap.open_ends == 0 && !cap.too_complex,
                                    cap.open_ends, cap.too_complex});
            caps_.push_back(std::move(cap));
            section.segments = {};  // gives its memory back
        }
    }

    SectionReport commit(Scene& scene, bool hatch) {
        Restore restore{scene, scene.meshes.size(), scene.materials.size(), scene.textures.size()};
        raster::CapMaterials materials(scene, hatch);
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            if (caps_[c].mesh.indices.empty()) continue;
            const SectionCut& cut = report_.cuts[c];
            const Instance& source = scene.instances[static_cast<std::size_t>(cut.instance)];
            caps_[c].mesh.material = materials.add(source, caps_[c].color, ordinals_[cut.part]);
        }
        scene.instances.reserve(scene.instances.size() + caps_.size());
        scene.meshes.reserve(scene.meshes.size() + caps_.size() + meshes_.size());
        restore.needed = false;
        // Nothing below needs memory.
        const auto add_mesh = [&](Mesh& mesh) {
            scene.meshes.push_back(std::move(mesh));
            return static_cast<int>(scene.meshes.size()) - 1;
        };
        for (auto& [instance, mesh] : meshes_) scene.instances[instance].mesh = add_mesh(mesh);
        for (const std::size_t instance : removed_) scene.instances[instance].visible = false;
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            if (caps_[c].mesh.indices.empty()) continue;
            report_.cuts[c].cap = static_cast<int>(scene.instances.size());
            scene.instances.push_back({add_mesh(caps_[c].mesh), caps_[c].world_from_object});
        }
        report_.instances_cut = meshes_.size();
        report_.instances_removed = removed_.size();
        return std::move(report_);
    }

private:
    /// Removes what was added to a scene.
    struct Restore {
        Scene& scene;
        std::size_t meshes, materials, textures;
        bool needed = true;
        ~Restore() {
            if (!needed) return;
            scene.materials.erase(scene.materials.begin() + static_cast<std::ptrdiff_t>(materials), scene.materials.end());
            scene.textures.erase(scene.textures.begin() + static_cast<std::ptrdiff_t>(textures), scene.textures.end());
        }
    };

    [[nodiscard]] int part_of(std::size_t instance) const { return parts_.empty() ? static_cast<int>(instance) : parts_[instance]; }

    /// By the box of the mesh; `some` where it does not tell.
    [[nodiscard]] Left left_of_box(const Bounds& box, const Mat4& place, const UnitPlane& plane) const {
        if (box.empty) return Left::all;
        bool above = true, below = true;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3f p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z};
            const double d = plane.distance(raster::placed_in_double(place, p));
            above = above && d > 2.0 * plane.tolerance;
            below = below && d < -2.0 * plane.tolerance;
        }
        return above ? Left::nothing : below ? Left::all : Left::some;
    }

    Result<const Bounds*> checked_bounds(std::size_t mesh) {
        std::optional<Bounds>& bounds = mesh_bounds_[mesh];
        if (!bounds) {
            if (!has_sound_arrays(scene_.meshes[mesh]))
                return fail(ErrorCode::bad_input, numbered("mesh", mesh) + ": an index or the length of an attribute is wrong");
            bounds.emplace();
            for (const Vec3f& p : scene_.meshes[mesh].positions) bounds->add(p);
        }
        return &*bounds;
    }

    Result<void> cut_instance(std::size_t index, int part) {
        const Instance& instance = scene_.instances[index];
        const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(instance.mesh)];
        const auto bounds = checked_bounds(static_cast<std::size_t>(instance.mesh));
        if (!bounds) return tl::unexpected(bounds.error());
        std::optional<Mesh> kept;
        bool removed = false;
        for (std::size_t p = 0; p < planes_.size(); ++p) {
            check_time();
            const Left by_box = left_of_box(**bounds, instance.world_from_object, planes_[p]);
            removed = removed || by_box == Left::nothing;
            if (by_box != Left::some) continue;
            const MeshCut whole(mesh, instance.world_from_object, planes_[p]);
            add_section(whole, index, part, p);
            if (removed) continue;
            std::optional<MeshCut> rest;  // the section is that of the whole mesh, what is kept that of what other planes left
            if (kept) rest.emplace(*kept, instance.world_from_object, planes_[p]);
            const MeshCut& cut = rest ? *rest : whole;
            const Left left = cut.left();
            removed = left == Left::nothing;
            if (left != Left::some) continue;
            Mesh next = cut.kept();
            rest.reset();
            kept = std::move(next);
            removed = kept->indices.empty();
        }
        if (removed)
            removed_.push_back(index);
        else if (kept)
            meshes_.emplace_back(index, std::move(*kept));
        return {};
    }

    void add_section(const MeshCut& cut, std::size_t index, int part, std::size_t plane) {
        std::vector<raster::CutSegment> segments;
        cut.add_section(segments);
        if (segments.empty()) return;
        const Instance& instance = scene_.instances[index];
        PlaneSection& section = sections_[{plane, part}];
        if (section.instance < 0) {
            section.instance = static_cast<int>(index);
            section.world_from_object = instance.world_from_object;
            section.color = mean_color(scene_.meshes[static_cast<std::size_t>(instance.mesh)]);
        } else if (section.world_from_object && *section.world_from_object != instance.world_from_object) {
            section.world_from_object.reset();
        }
        section.segments.insert(section.segments.end(), segments.begin(), segments.end());
    }

    static Vec3f mean_color(const Mesh& mesh) {
        if (mesh.colors.empty()) return {1, 1, 1};
        Vec3d sum;
        for (const Vec4f& c : mesh.colors) sum = sum + Vec3d{c.x, c.y, c.z};
        return to_float(sum * (1.0 / static_cast<double>(mesh.colors.size())));
    }

    const Scene& scene_;
    std::span<const int> parts_;
    Bounds bounds_;
    std::vector<std::optional<Bounds>> mesh_bounds_;                // object space; none: not looked at yet
    std::vector<UnitPlane> planes_;                                 // each once
    std::vector<std::size_t> given_;                                // their indices as given
    std::map<int, int> ordinals_;                                   // of each part among all parts
    std::map<std::pair<std::size_t, int>, PlaneSection> sections_;  // by plane and part
    std::vector<std::pair<std::size_t, Mesh>> meshes_;              // new ones, with their instances
    std::vector<std::size_t> removed_;
    std::vector<CapMesh> caps_;  // one for each cut of the report; some are empty
    SectionReport report_;
};

}  // namespace

Result<SectionReport> cut_scene(Scene& scene, std::span<const CutPlane> planes, const SectionSettings& settings,
                                std::span<const int> part_of_instance) {
    return raster::guarded("cutting a scene", {}, [&]() -> Result<SectionReport> {
        if (const auto checked = check_cut(scene, planes, settings, part_of_instance); !checked) return tl::unexpected(checked.error());
        SceneCutter cutter(scene, planes, part_of_instance);
        if (const auto cut = cutter.cut_instances(); !cut) return tl::unexpected(cut.error());
        cutter.make_caps(settings);
        return cutter.commit(scene, settings.hatch);
    });
}

}  // namespace halflit
