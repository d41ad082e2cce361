#include "apps/engine/mujoco/geom_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace halflit::engine::mujoco {
namespace {

/// A part of a primitive: factors on its size across z and along it. turned: half a turn about x.
struct PartRow {
    GeomType type;
    Shape shape;
    float across, along, shift;
    bool turned = false;
};
constexpr PartRow kParts[] = {
    {kSphere, Shape::sphere, 1, 1, 0},
    {kEllipsoid, Shape::sphere, 1, 1, 0},
    {kCylinder, Shape::cylinder, 1, 1, 0},
    {kBox, Shape::box, 1, 1, 0},
    {kLineBox, Shape::line_box, 1, 1, 0},
    {kTriangle, Shape::triangle, 1, 1, 0},
    {kLine, Shape::line, 0, 1, 0},
    {kArrow, Shape::cylinder, 1, 1 / 6.0f, 1 / 6.0f},
    {kArrow, Shape::cone, 1.75f, 1 / 6.0f, 2 / 6.0f},
    {kArrow1, Shape::cylinder, 1, 1 / 6.0f, 1 / 6.0f},
    {kArrow1, Shape::cone, 1, 1 / 6.0f, 2 / 6.0f},
    {kArrow2, Shape::tube, 1, 1 / 3.0f, 0},
    {kArrow2, Shape::cone, 1.75f, 1 / 6.0f, -2 / 6.0f, true},
    {kArrow2, Shape::cone, 1.75f, 1 / 6.0f, 2 / 6.0f},
};

bool is_surface_of_shapes(std::int32_t type) {
    const auto has_row = std::any_of(std::begin(kParts), std::end(kParts), [&](const PartRow& row) { return row.type == type; });
    return type == kPlane || type == kCapsule || (has_row && type != kLine && type != kLineBox);
}

/// A flat texture by coordinates of the shape, from 0 to 1, times the repetition.
void set_texture_by_uv(const Geom& g, FixedMaterial& m) {
    const TextureUse& use = g.use;
    const float size[2] = {g.size.x, g.size.y};
    float scale[2];
    for (int k = 0; k < 2; ++k) {
        scale[k] = use.repeat[k] > 0 ? use.repeat[k] : 1.0f;
        if (use.uniform && size[k] > 0) scale[k] *= size[k];
    }
    m.texture = use.texture;
    m.uv_scale = {scale[0], scale[1]};
    if (g.type != kPlane) return;
    // Planes of the model have their true size, or none, and others that of the unit shape.
    m.generated = true;
    const float shift = size[0] > 0 && size[1] > 0 ? 0.0f : -0.5f;
    for (int k = 0; k < 2; ++k) {
        const float half = 0.5f * scale[k], slope = (k == 0 ? half : -half) / (g.dataid >= 0 && size[k] > 0 ? size[k] : 1.0f);
        m.planes[k] = {k == 0 ? slope : 0, k == 1 ? slope : 0, 0, (size[k] > 0 ? half : 0.0f) + shift};
    }
}

/// A texture by the mesh's own coordinates, or by the position in the shape: two coordinates of it, or its direction.
void set_texture(const Geom& g, const std::vector<bool>& cubes, bool shapes_have_uv, FixedMaterial& m) {
    const TextureUse& use = g.use;
    if (use.texture < 0) return;
    const bool cube = cubes[static_cast<std::size_t>(use.texture)], own = g.texcoord > 0;
    if (cube && own) return;  // OpenGL binds a cube to the wrong target
    if (shapes_have_uv && !cube && (own || is_surface_of_shapes(g.type))) return set_texture_by_uv(g, m);
    m.texture = use.texture;
    if (own) return;
    m.generated = true;
    const float size[3] = {g.size.x, g.size.y, g.size.z};
    if (cube) {
        const auto scale = [&](int k) { return use.uniform ? size[k] : 1.0f; };
        m.planes[0] = {scale(0), 0, 0, 0}, m.planes[1] = {0, scale(1), 0, 0}, m.planes[2] = {0, 0, scale(2), 0};
        return;
    }
    float scale[2] = {use.repeat[0], use.repeat[1]};
    for (int k = 0; k < 2; ++k) {
        if (size[k] <= 0) continue;
        // Planes of the model, meshes and height fields have their true size, the other shapes that of the unit shape.
        if (g.dataid >= 0) scale[k] /= size[k];
        if (use.uniform) scale[k] *= size[k];
    }
    m.planes[0] = {0.5f * scale[0], 0, 0, -0.5f}, m.planes[1] = {0, -0.5f * scale[1], 0, -0.5f};
}

}  // namespace

Result<void> check_geom(const Geom& geom, int index, const ModelMeshes& n) {
    const auto [name, found, count] = [&]() -> std::tuple<const char*, int, int> {
        switch (geom.type) {
            case kPlane:
                return {"dataid", geom.dataid, static_cast<int>(n.planes.size())};
            case kHField:
                return {"dataid", geom.dataid, n.skins - n.hfields};
            case kMesh:
            case kSdf:
                return {"dataid", geom.dataid, n.hfields - n.models};
            case kSkin:
                return {"objid", geom.objid, n.flexes - n.skins};
            case kFlex:
                return {"objid", geom.objid, n.end - n.flexes};
            default:
                return {"", -1, 0};
        }
    }();
    if (found < count) return {};
    return fail(ErrorCode::bad_input, fmt::format("geom {}: {} is {}, the model has {}", index, name, found, count));
}

std::vector<Part> parts_of(const Geom& g, const ModelMeshes& n, const Scene& scene, bool mirrors) {
    const Vec3f s = g.size;
    switch (g.type) {
        case kPlane:
            if (g.dataid >= 0) return {{.mesh = n.planes[static_cast<std::size_t>(g.dataid)], .mirrors = mirrors}};
            return {{static_cast<int>(Shape::plane), {s.x, s.y, 1}, 0, mirrors}};
        case kHField:
            if (g.dataid < 0) return {};
            return {{.mesh = n.hfields + g.dataid}};
        case kMesh:
        case kSdf:
            if (g.dataid < 0) return {};
            return {{.mesh = n.models + g.dataid}};
        case kSkin:
            if (scene.skinvert == nullptr || scene.skinnormal == nullptr || g.objid < 0) return {};
            return {{.mesh = n.skins + g.objid}};
        case kFlex:
            if (scene.flexfaceused == nullptr || scene.flexface == nullptr || scene.flexnormal == nullptr || g.objid < 0) return {};
            return {{.mesh = n.flexes + g.objid}};
        case kCapsule: {
            const auto radius = static_cast<float>(0.5 * static_cast<double>(s.x + s.y));
            return {{static_cast<int>(Shape::tube), s, 0},
                    {static_cast<int>(Shape::upper_cap), {s.x, s.y, radius}, s.z - radius},
                    {static_cast<int>(Shape::lower_cap), {s.x, s.y, radius}, radius - s.z}};
        }
        case kBox:
            if (mirrors) return {{static_cast<int>(Shape::box_top), s, 0, true}, {static_cast<int>(Shape::box_rest), s}};
            break;
        default:
            break;
    }
    std::vector<Part> parts;
    for (const PartRow& row : kParts) {
        if (row.type != g.type) continue;
        const float turn = row.turned ? -1.0f : 1.0f;
        const Vec3f scale = row.across > 0 ? Vec3f{s.x * row.across, s.y * row.across * turn, s.z * row.along * turn} : Vec3f{1, 1, s.z};
        parts.push_back({static_cast<int>(row.shape), scale, s.z * row.shift});
    }
    return parts;
}

FixedMaterial material_of(const Geom& g, const std::vector<bool>& cubes, bool shapes_have_uv, bool behind) {
    FixedMaterial m;
    m.color = g.rgba;
    if (behind) m.color.w = static_cast<float>(0.3 * static_cast<double>(m.color.w));
    m.emission = Vec3f{g.rgba.x, g.rgba.y, g.rgba.z} * g.emission;
    m.specular = g.specular;
    m.shininess = std::clamp(g.shininess * 128.0f, 0.0f, 128.0f);
    set_texture(g, cubes, shapes_have_uv, m);
    return m;
}

}  // namespace halflit::engine::mujoco
