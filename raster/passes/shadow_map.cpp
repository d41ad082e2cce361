#include "raster/passes/shadow_map.hpp"

#include "raster/passes/binning.hpp"
#include "raster/passes/geometry.hpp"
#include "raster/view/view_math.hpp"

#include <algorithm>
#include <string>

namespace halflit::raster {
namespace {

using shading::LightPlan;
using shading::LightType;
using shading::ShadowMapPlan;

struct Axes {
    Vec3d right, up, back;
};

Vec3d unit(Vec3d v) { return v * (1.0 / length(v)); }

/// A camera's axes for looking along -back.
Axes axes_for(Vec3d back) {
    const double ay = back.y < 0 ? -back.y : back.y;
    const Vec3d right = unit(cross(ay < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, back));
    return {right, cross(back, right), back};
}

Camera camera_at(const Axes& axes, Vec3d eye) {
    const auto column = [](Vec3d v, float w) {
        return Vec4f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
    };
    Camera camera;
    camera.world_from_camera = {{column(axes.right, 0), column(axes.up, 0), column(axes.back, 0), column(eye, 1)}};
    return camera;
}

Vec3d to_double(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

void set_row(float (&row)[4], Vec3d direction, double offset) {
    row[0] = static_cast<float>(direction.x);
    row[1] = static_cast<float>(direction.y);
    row[2] = static_cast<float>(direction.z);
    row[3] = static_cast<float>(offset);
}

/// Rows for a camera: u and v in texels (times distance when perspective), and distance along the view.
void set_rows(ShadowMapPlan& map, const Axes& axes, Vec3d eye, double half) {
    const double s = 0.5 * map.size / half;
    const Vec3d forward = axes.back * -1.0;
    // The centre of the map, times distance in perspective.
    const Vec3d middle = map.kind == ShadowMapPlan::Kind::perspective ? forward * (0.5 * map.size) : Vec3d{};
    const double constant = map.kind == ShadowMapPlan::Kind::perspective ? 0.0 : 0.5 * map.size;
    const Vec3d u = axes.right * s + middle, v = axes.up * -s + middle;
    set_row(map.rows[0], u, constant - dot(u, eye));
    set_row(map.rows[1], v, constant - dot(v, eye));
    set_row(map.rows[2], forward, -dot(forward, eye));
}

/// Whether any light can fall on the scene from there.
bool reaches(const LightPlan& light, const Bounds& bounds) {
    if (light.type == LightType::directional || light.inv_range_squared == 0.0f) return true;
    const Vec3f c = bounds.center();
    const double distance = length(to_double(light.position) - Vec3d{c.x, c.y, c.z}) - bounds.radius();
    return distance <= 0.0 || distance * distance * light.inv_range_squared < 1.0;
}

/// Tangent of a spot's outer angle; 0 when it is too wide for one map.
double cone_tangent(const LightPlan& light) {
    const double cosine = 1.0 - static_cast<double>(light.cone_cutoff);
    return cosine < 0.25 ? 0.0 : __builtin_sqrt(std::max(0.0, 1.0 - cosine * cosine)) / cosine;
}

/// Whether it takes six maps.
bool is_cube(const LightPlan& light) {
    return light.type == LightType::point || (light.type == LightType::spot && cone_tangent(light) == 0.0);
}

int size_of(const LightPlan& light, int side) { return is_cube(light) ? side / 2 : side; }

/// Texels of all maps, `side` being the size of those that are not a cube's.
std::size_t texel_count(const shading::ShadingPlan& plan, const Bounds& bounds, int side) {
    std::size_t count = 0;
    for (const LightPlan& light : plan.lights) {
        if (!reaches(light, bounds)) continue;
        const auto size = static_cast<std::size_t>(size_of(light, side));
        count += size * size * (is_cube(light) ? 6 : 1);
    }
    return count;
}

/// Whether a camera with a square field of view can see anything of a box: not when all corners are behind it or beyond one side.
bool can_see(const Axes& axes, Vec3d eye, double half, const Bounds& bounds) {
    int behind = 0, beyond[4] = {};
    for (int k = 0; k < 8; ++k) {
        const Vec3d p{k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y, k & 4 ? bounds.max.z : bounds.min.z};
        const Vec3d q = p - eye;
        const double x = dot(q, axes.right), y = dot(q, axes.up), reach = -dot(q, axes.back) * half;
        behind += reach < 0.0;
        beyond[0] += x > reach, beyond[1] += -x > reach, beyond[2] += y > reach, beyond[3] += -y > reach;
    }
    return behind < 8 && beyond[0] < 8 && beyond[1] < 8 && beyond[2] < 8 && beyond[3] < 8;
}

}  // namespace

void set_shadow_fades(Frame& frame) {
    frame.plan.shadow_mode = frame.plan.shadow_maps.empty() ? shading::ShadowMode::off : frame.settings->shadows;
    frame.plan.shadow_offset = frame.plan.shadow_mode != shading::ShadowMode::off && frame.settings->shadow_terminator_offset;
    if (frame.plan.shadow_mode != shading::ShadowMode::soft_split) return;
    std::vector<double> radius(frame.plan.materials.size(), 0.0);
    for (const Draw& draw : frame.draws) {
        const auto material = static_cast<std::size_t>(draw.material);
        if (frame.plan.materials[material].lobe.wrap <= 0.0f) continue;
        Bounds bounds;
        for (const Vec3f& p : draw.mesh->positions) bounds.add(transform_point(draw.world_from_object, p));
        // The sphere of that bounding box.
        if (!bounds.empty) radius[material] = std::max(radius[material], bounds.radius() / 1.7320508075688772);
    }
    constexpr double kOwn = shading::kOwnThickness;
    for (std::size_t i = 0; i < radius.size(); ++i) {
        shading::MaterialPlan& plan = frame.plan.materials[i];
        if (plan.lobe.wrap <= 0.0f) continue;
        const double fade = frame.settings->shadow_fade > 0.0f ? frame.settings->shadow_fade : 2.0 / kOwn * plan.lobe.wrap * radius[i];
        plan.shadow_fade_scale = fade > 1e-30 ? static_cast<float>(1.0 / fade) : 0.0f;
        plan.shadow_turn_scale = static_cast<float>(kOwn / plan.lobe.wrap);
    }
}

Result<void> ShadowMaps::draw_face(const Scene& scene, const Camera& camera, int size, bool perspective, const Settings& settings,
                                   Executor& executor, float* distance) {
    Settings whole_map = settings;
    whole_map.region = {};
    whole_map.samples = 1;
    whole_map.background_environment = false;
    frame_.depth_only = true;
    if (auto ok = prepare_frame(frame_, scene, camera, whole_map, {size, size, nullptr, nullptr}); !ok) return ok;
    transform_vertices(frame_, executor);
    bin_triangles(frame_, executor);
    if (frame_.has_mask) {  // the alpha test reads attributes
        make_vertex_records(frame_, executor);
        make_clip_records(frame_, executor);
    }
    executor.run(frame_.tiles_x * frame_.tiles_y, [&](int tile) {
        Pool<TileScratch>::Loan loan(scratch_);
        TileRenderer(frame_, tile, *loan).draw_visibility();
        const TileRect rect = frame_.tile_rect(tile);
        for (int y = 0; y < rect.height; ++y) {
            const float* depth = loan->buffers.depth[0] + y * kTileStride;
            float* out =
                distance + static_cast<std::size_t>(rect.y + y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(rect.x);
            for (int x = 0; x < rect.width; ++x) {
                const float z = depth[x];
                const float d = perspective ? camera.near_z / z : camera.far_z - z * (camera.far_z - camera.near_z);
                out[x] = z > 0.0f && d < shading::kNoBlocker ? d : shading::kNoBlocker;
            }
        }
    });
    return {};
}

Result<void> ShadowMaps::draw(const Scene& scene, const Settings& settings, Executor& executor, shading::ShadingPlan& plan) {
    plan.shadow_maps.clear();
    warning_.clear();
    int side = settings.shadow_size;
    if (side < 64 || side > 4096 || (side & (side - 1)) != 0)
        return fail(ErrorCode::usage, "shadow size: " + std::to_string(side) + ", expected a power of two from 64 to 4096");
    if (settings.shadows == shading::ShadowMode::off || plan.lights.empty()) return {};
    const Bounds bounds = scene_bounds(scene);
    if (bounds.empty || !(bounds.radius() > 0.0f)) return {};
    const std::size_t most = settings.shadow_memory_limit / sizeof(float);
    while (side > 64 && texel_count(plan, bounds, side) > most) side /= 2;
    if (texel_count(plan, bounds, side) > most)
        return fail(ErrorCode::limit, "shadow maps of " + std::to_string(plan.lights.size()) + " lights do not fit in " +
                                          std::to_string(settings.shadow_memory_limit) + " bytes even at 64 texels a side");
    if (side < settings.shadow_size)
        warning_ = "shadow maps of " + std::to_string(side) + " texels a side instead of " + std::to_string(settings.shadow_size) +
                   ", to stay within " + std::to_string(settings.shadow_memory_limit) + " bytes";
    float* out = texels_.reserve(texel_count(plan, bounds, side));
    const Vec3f c = bounds.center();
    const Vec3d center{c.x, c.y, c.z};
    const double radius = bounds.radius();
    for (LightPlan& light : plan.lights) {
        light.shadow_map = -1;
        if (!reaches(light, bounds)) continue;
        ShadowMapPlan map;
        map.size = size_of(light, side);
        map.distance = out;
        const double usable = static_cast<double>(map.size) / (map.size - 2 * shading::kShadowBorder);
        const auto texels = static_cast<std::size_t>(map.size) * static_cast<std::size_t>(map.size);
        // What stands closer than the source's own radius is taken for the lamp itself.
        const double least_distance = std::max({1e-4 * radius, __builtin_sqrt(static_cast<double>(light.min_distance_squared)), 1e-30});
        if (light.type == LightType::directional) {
            // The box around the scene's box, seen along the light.
            const Axes axes = axes_for(unit(to_double(light.to_light)));
            double half = 0.0, depth = 0.0;
            for (int k = 0; k < 8; ++k) {
                const Vec3f p{k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y,
                              k & 4 ? bounds.max.z : bounds.min.z};
                const Vec3d q = Vec3d{p.x, p.y, p.z} - center;
                const double x = dot(q, axes.right), y = dot(q, axes.up), z = dot(q, axes.back);
                half = std::max({half, x, -x, y, -y});
                depth = std::max({depth, z, -z});
            }
            half = std::max(half, 1e-3 * radius) * usable;
            depth = std::max(depth, 1e-3 * radius) * 1.01;
            const Vec3d eye = center + axes.back * depth;
            Camera camera = camera_at(axes, eye);
            camera.orthographic = true;
            camera.half_width = camera.half_height = static_cast<float>(half);
            camera.near_z = 0.0f;
            camera.far_z = static_cast<float>(2.0 * depth);
            map.kind = ShadowMapPlan::Kind::orthographic;
            map.texel_size = static_cast<float>(2.0 * half / map.size);
            set_rows(map, axes, eye, half);
            if (auto ok = draw_face(scene, camera, map.size, false, settings, executor, out); !ok) return ok;
            out += texels;
        } else if (!is_cube(light)) {
            const Axes axes = axes_for(unit(to_double(light.to_light)));
            const double half = cone_tangent(light) * usable;
            const Vec3d eye = to_double(light.position);
            Camera camera = camera_at(axes, eye);
            camera.fov_y_rad = static_cast<float>(2.0 * arc_tangent(half));
            camera.near_z = static_cast<float>(least_distance);
            map.kind = ShadowMapPlan::Kind::perspective;
            map.texel_size = static_cast<float>(2.0 * half / map.size);
            set_rows(map, axes, eye, half);
            if (auto ok = draw_face(scene, camera, map.size, true, settings, executor, out); !ok) return ok;
            out += texels;
        } else {
            map.kind = ShadowMapPlan::Kind::cube;
            map.texel_size = static_cast<float>(2.0 * usable / map.size);
            for (int i = 0; i < 3; ++i) map.origin[i] = light.position[i];
            for (int face = 0; face < 6; ++face) {
                // Face 2 a looks along +axis a, face 2 a + 1 along -axis a; u follows axis a + 1, v axis a + 2 with the face's sign.
                const double sign = (face & 1) ? -1.0 : 1.0;
                const Vec3d e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
                const int a = face / 2;
                const Axes axes{e[(a + 1) % 3], e[(a + 2) % 3] * -sign, e[a] * -sign};
                Camera camera = camera_at(axes, to_double(light.position));
                camera.fov_y_rad = static_cast<float>(2.0 * arc_tangent(usable));
                camera.near_z = static_cast<float>(least_distance);
                if (!can_see(axes, to_double(light.position), usable, bounds))
                    std::fill_n(out, texels, shading::kNoBlocker);
                else if (auto ok = draw_face(scene, camera, map.size, true, settings, executor, out); !ok)
                    return ok;
                out += texels;
            }
        }
        light.shadow_map = static_cast<std::int32_t>(plan.shadow_maps.size());
        plan.shadow_maps.push_back(map);
    }
    return {};
}

}  // namespace halflit::raster
