#include "raster/view/shadow_views.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/view/shadow_cascades.hpp"
#include "raster/view/shadow_fit.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <optional>

namespace halflit::raster {
namespace {

using shading::LightPlan;
using shading::ShadowMapPlan;

Camera camera_at(const ViewAxes& axes, Vec3d eye) {
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

/// Sets a map's rows: u and v in texels (perspective: times the distance), and the distance along the view. half: half the width of the
/// view, world units (perspective: at distance 1).
void set_rows(ShadowMapPlan& map, const ViewAxes& axes, Vec3d eye, double half) {
    const double s = 0.5 * map.size / half;
    const Vec3d forward = axes.back * -1.0;
    // Offset to the centre of the map; perspective: times the distance.
    const Vec3d middle = map.kind == ShadowMapPlan::Kind::perspective ? forward * (0.5 * map.size) : Vec3d{};
    const double constant = map.kind == ShadowMapPlan::Kind::perspective ? 0.0 : 0.5 * map.size;
    const Vec3d u = axes.right * s + middle, v = axes.up * -s + middle;
    set_row(map.rows[0], u, constant - dot(u, eye));
    set_row(map.rows[1], v, constant - dot(v, eye));
    set_row(map.rows[2], forward, -dot(forward, eye));
}

double distance_to_middle(const LightPlan& light, const Bounds& bounds) {
    return length(to_double(light.position) - to_double(bounds.center()));
}

/// True if the light's range reaches the scene's bounds.
bool reaches(const LightPlan& light, const Bounds& bounds) {
    if (!kind_of(light.type).placed || light.inv_range_squared == 0.0f) return true;
    const double distance = distance_to_middle(light, bounds) - bounds.radius();
    return distance <= 0.0 || distance * distance * light.inv_range_squared < 1.0;
}

/// Tangent of a spot's outer angle; 0 when it is too wide for one map.
double cone_tangent(const LightPlan& light) {
    const double cosine = 1.0 - static_cast<double>(light.cone_cutoff);
    return cosine < 0.25 ? 0.0 : __builtin_sqrt(std::max(0.0, 1.0 - cosine * cosine)) / cosine;
}

/// True if a camera with a square field of view may see some of a box: not all corners are behind it or beyond one side. half: tangent of
/// half the field of view.
bool can_see(const ViewAxes& axes, Vec3d eye, double half, const Bounds& bounds) {
    int behind = 0, beyond[4] = {};
    for_corners(bounds, [&](Vec3d p) {
        const Vec3d q = p - eye;
        const double x = dot(q, axes.right), y = dot(q, axes.up), width = -dot(q, axes.back) * half;
        behind += width < 0.0;
        beyond[0] += x > width, beyond[1] += -x > width, beyond[2] += y > width, beyond[3] += -y > width;
    });
    return behind < 8 && beyond[0] < 8 && beyond[1] < 8 && beyond[2] < 8 && beyond[3] < 8;
}

/// Distance of a light's near plane. Geometry closer than the source's radius counts as the light itself.
double least_distance(const LightPlan& light, const Bounds& bounds) {
    return std::max({1e-4 * double{bounds.radius()}, __builtin_sqrt(static_cast<double>(light.min_distance_squared)), 1e-30});
}

/// The map that a light gets.
struct Choice {
    ShadowMapPlan::Kind kind = ShadowMapPlan::Kind::cube;
    FittedView view;             ///< not of cubes
    std::vector<Bounds> boxes;   ///< what it has to show; empty: there is no map
    std::vector<double> depths;  ///< reach of the finer cascades
    int side = 0;                ///< texels on a side; a cube's faces have half
};

/// Wider views than this have larger texels than the faces of a cube. It is the tangent of half the angle.
constexpr double kWidestView = 2.0;

/// The view along a world axis from a light that would get a cube, if all that is seen lies in it and it is then cut. Of several axes it is
/// the one along which what is seen lies farthest ahead.
std::optional<FittedView> instead_of_cube(Vec3d place, double near_z, const SeenVolume& seen, const Bounds& bounds, int side) {
    std::optional<FittedView> best;
    double farthest = 0.0;
    for (const Vec3d back : {Vec3d{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
        FittedView view = fixed_view(place, back, kWidestView);
        view.near_z = near_z;
        const double nearest = nearest_if_all_seen(view, seen);
        if (!(nearest > farthest)) continue;
        farthest = nearest;
        best = view;
    }
    if (!best) return best;
    FittedView after = *best;
    if (cut_view(after, false, side, seen, bounds) != MapUse::cut) best.reset();
    return best;
}

Choice choose(const LightPlan& light, const Bounds& bounds, const ShadowCasters& casters, const SeenVolume* seen, int side) {
    Choice choice;
    if (!reaches(light, bounds)) return choice;
    const bool directional = !kind_of(light.type).placed;
    const Vec3d place = to_double(directional ? light.to_light : light.position);
    choice.boxes = casters.of_light(place, directional);
    if (choice.boxes.empty()) return choice;
    if (directional) {
        choice.kind = ShadowMapPlan::Kind::orthographic;
        choice.view = fit_directional(place, choice.boxes, bounds);
        return choice;
    }
    const double cone = kind_of(light.type).cone ? cone_tangent(light) : 0.0;
    std::optional<FittedView> view = fit_lamp(place, choice.boxes, bounds, cone > 0.0 ? std::min(cone, kWidestView) : kWidestView);
    if (!view && cone > 0.0) view = fixed_view(place, unit(to_double(light.to_light)), cone);
    if (!view && seen != nullptr) view = instead_of_cube(place, least_distance(light, bounds), *seen, bounds, side);
    if (!view) return choice;
    choice.kind = ShadowMapPlan::Kind::perspective;
    choice.view = *view;
    choice.view.near_z = std::max(view->near_z, least_distance(light, bounds));
    return choice;
}

/// The side that gives a texel the width that is asked for where a picture sees the scene: at the geometric mean of its depths, and up
/// to 1.5 times that width nearest to the camera. Sides are quarters of a power of two, so that a camera that moves a little gets the same
/// map.
int side_for(const Choice& choice, const LightPlan& light, const Bounds& bounds, const SeenVolume* seen, const ShadowSizes& sizes) {
    if (seen == nullptr || sizes.texel_px == 0.0) return sizes.most;
    const double low = std::max(0.0, seen->depth.low);
    const double depth = seen->perspective ? std::min(__builtin_sqrt(low * seen->depth.high), 1.5 * low) : 1.0;
    const double texel = sizes.texel_px * seen->pixel * depth;
    double width = 2.0;  // of what the map shows, world units; of what the four faces show that a cube's side stands for
    if (choice.kind == ShadowMapPlan::Kind::orthographic) {
        const std::optional<int> rung = ladder_rung(choice.view, sizes.most, *seen);
        width = rung ? ladder_width(choice.view, *rung) : 0.0;
    } else {
        const bool cube = choice.kind == ShadowMapPlan::Kind::cube;
        width *= (cube ? 2.0 : choice.view.half) * std::max(distance_to_middle(light, bounds), double{bounds.radius()});
    }
    int side = kLeastShadowSize;
    for (int step = kShadowSizeStep; side < sizes.most && !(side * texel >= width); side += step)
        if (side == 8 * step) step *= 2;
    return std::min(side, sizes.most);
}

int size_of(const Choice& choice) { return choice.kind == ShadowMapPlan::Kind::cube ? choice.side / 2 : choice.side; }

std::size_t wide_texels(int size) {
    return static_cast<std::size_t>(shading::wide_side(size)) * static_cast<std::size_t>(shading::wide_side(size));
}

/// Number of texels of all maps.
std::size_t texel_count(std::span<const Choice> choices, bool penumbras) {
    std::size_t count = 0;
    for (const Choice& choice : choices) {
        if (choice.boxes.empty()) continue;
        const auto size = static_cast<std::size_t>(size_of(choice));
        const bool is_wide = penumbras && choice.kind == ShadowMapPlan::Kind::orthographic;
        const std::size_t of_map = size * size + (is_wide ? wide_texels(size_of(choice)) : 0);
        count += of_map * (choice.kind == ShadowMapPlan::Kind::cube ? 6 : 1 + choice.depths.size());
    }
    return count;
}

/// Against maps of 4096, 1280x720: a map of twice the picture's longer side is off by more than 8 codes in .2 % of the pixels (mean of six
/// models), texels of 2/3 of a pixel in .25 %, of a whole one in .35 %, for .91 and .87 of the frame's time.
constexpr double kTexelPx = 2.0 / 3.0;

/// Plans the maps one after the other.
class Planner {
public:
    /// penumbra: ShadowMapPlan::penumbra of directional lights.
    Planner(const Bounds& bounds, const SeenVolume* seen, double penumbra, ShadowViews& out)
        : bounds_(bounds), seen_(seen), penumbra_(static_cast<float>(penumbra)), out_(out) {}

    void add(const LightPlan& light, const Choice& choice) {
        ShadowMapPlan map;
        map.kind = choice.kind;
        map.size = size_of(choice);
        out_.map_of_light.back() = static_cast<std::int32_t>(out_.maps.size());
        const double usable = static_cast<double>(map.size) / (map.size - 2 * shading::kShadowBorder);
        if (map.kind == ShadowMapPlan::Kind::cube) {
            begin_map();
            add_cube(light, choice.boxes, map, usable);
            out_.maps.push_back(map);
        } else {
            add_fitted(choice, map, usable);
        }
    }

private:
    void begin_map() { out_.first_texel.push_back(out_.texel_count), out_.first_wide.push_back(out_.wide_count); }

    void add_fitted(const Choice& choice, ShadowMapPlan& map, double usable) {
        const bool orthographic = map.kind == ShadowMapPlan::Kind::orthographic;
        FittedView view = choice.view;
        const MapUse use = seen_ != nullptr ? cut_view(view, orthographic, map.size, *seen_, bounds_) : MapUse::whole;
        if (!choice.depths.empty() && use != MapUse::none) {
            const std::vector<FittedView> finer = cascade_views(choice.view, view, map.size, *seen_, choice.depths, bounds_);
            for (std::size_t i = 0; i < finer.size(); ++i) {
                map.coarser = static_cast<std::int32_t>(finer.size() - i);
                add_flat(finer[i], true, map, usable);
            }
            map.coarser = 0;
        }
        add_flat(view, use != MapUse::none, map, usable);
    }

    void add_flat(const FittedView& view, bool sees_casters, ShadowMapPlan map, double usable) {
        begin_map();
        const double half = view.half * usable;
        Camera camera = camera_at(view.axes, view.eye);
        camera.orthographic = map.kind == ShadowMapPlan::Kind::orthographic;
        if (camera.orthographic) {
            camera.half_width = camera.half_height = static_cast<float>(half);
            camera.near_z = 0.0f;
            camera.far_z = static_cast<float>(view.far_z);
        } else {
            camera.fov_y_rad = static_cast<float>(2.0 * arc_tangent(half));
            camera.near_z = static_cast<float>(view.near_z);
        }
        if (camera.orthographic) map.penumbra = penumbra_;
        set_texel_size(map, half, !camera.orthographic);
        set_rows(map, view.axes, view.eye, half);
        add_view(map, camera, sees_casters);
        out_.maps.push_back(map);
    }

    void add_cube(const LightPlan& light, std::span<const Bounds> boxes, ShadowMapPlan& map, double usable) {
        set_texel_size(map, usable, true);
        const Vec3d eye = to_double(light.position);
        for (int i = 0; i < 3; ++i) map.origin[i] = light.position[i];
        for (int face = 0; face < 6; ++face) {
            // Face 2 a looks along +axis a, face 2 a + 1 along -axis a; u follows axis a + 1, v axis a + 2 with the face's sign.
            const double sign = (face & 1) ? -1.0 : 1.0;
            const Vec3d e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            const int a = face / 2;
            const ViewAxes axes{e[(a + 1) % 3], e[(a + 2) % 3] * -sign, e[a] * -sign};
            Camera camera = camera_at(axes, eye);
            camera.fov_y_rad = static_cast<float>(2.0 * arc_tangent(usable));
            camera.near_z = static_cast<float>(least_distance(light, bounds_));
            const bool shades = seen_ == nullptr || can_see(axes, eye, usable, *seen_);
            add_view(map, camera,
                     shades && std::any_of(boxes.begin(), boxes.end(), [&](const Bounds& box) { return can_see(axes, eye, usable, box); }));
        }
    }

    static void set_texel_size(ShadowMapPlan& map, double half, bool perspective) {
        map.texel_size = static_cast<float>(2.0 * half / map.size);
        map.offset = shading::shadow_offset(perspective ? map.texel_size : 0.0f);
    }

    void add_view(const ShadowMapPlan& map, const Camera& camera, bool sees_casters) {
        ShadowView& face = out_.views.emplace_back();
        face.view = make_view(camera, map.size, map.size, {}, kMaxTileSize, 1);
        face.perspective = !camera.orthographic;
        face.near_z = camera.near_z;
        face.far_z = camera.far_z;
        face.first_texel = out_.texel_count;
        face.sees_casters = sees_casters;
        out_.texel_count += static_cast<std::size_t>(map.size) * static_cast<std::size_t>(map.size);
        face.penumbra = map.penumbra > 0.0f;
        face.first_wide = out_.wide_count;
        if (face.penumbra) out_.wide_count += wide_texels(map.size);
    }

    const Bounds& bounds_;
    const SeenVolume* seen_;
    float penumbra_;
    ShadowViews& out_;
};

}  // namespace

ShadowSizes shadow_sizes(const Settings& settings, int width_px, int height_px) {
    if (settings.shadow_size > 0) return {settings.shadow_size};
    const int side = (2 * std::max(width_px, height_px) + kShadowSizeStep - 1) / kShadowSizeStep * kShadowSizeStep;
    return {std::clamp(side, kLeastShadowSize, ShadowSizes{}.most), kTexelPx};
}

Result<ShadowViews> plan_shadow_views(std::span<const LightPlan> lights, const PreparedData& scene, const SeenVolume* seen,
                                      const Settings& settings, const ShadowSizes& sizes) {
    ShadowViews out;
    const Bounds& bounds = scene.bounds();
    if (settings.shadows == ShadowMode::off || lights.empty() || bounds.empty || !(bounds.radius() > 0.0f)) return out;
    std::optional<double> nearest;
    const auto nearest_seen = [&] {
        if (!nearest) nearest = nearest_depth(scene, *seen);
        return *nearest;
    };
    std::vector<Choice> choices;
    int largest = 0;
    for (const LightPlan& light : lights) {
        Choice& choice = choices.emplace_back(choose(light, bounds, scene.shadow_casters(), seen, sizes.most));
        if (choice.boxes.empty()) continue;
        choice.side = side_for(choice, light, bounds, seen, sizes);
        largest = std::max(largest, choice.side);
        if (seen != nullptr && choice.kind == ShadowMapPlan::Kind::orthographic)
            choice.depths = cascade_depths(choice.view, choice.side, *seen, nearest_seen);
    }
    const std::size_t most = settings.shadow_memory_limit / sizeof(float);
    const SinCos softness = sin_cos(static_cast<double>(settings.shadow_softness_deg) * (kPi / 180.0));
    const double penumbra = 2.0 * softness.sin / softness.cos;
    int side = largest;
    while (side > kShadowSizeStep && texel_count(choices, penumbra > 0.0) > most) {
        side = halved_shadow_size(side);
        for (Choice& choice : choices) choice.side = std::min(choice.side, side);
    }
    if (texel_count(choices, penumbra > 0.0) > most)
        return fail(ErrorCode::limit, "shadow maps of " + std::to_string(lights.size()) + " lights do not fit in " +
                                          std::to_string(settings.shadow_memory_limit) + " bytes even at 64 texels a side");
    if (side < largest)
        out.warning = "shadow maps of " + std::to_string(side) + " texels a side instead of " + std::to_string(largest) +
                      ", to stay within " + std::to_string(settings.shadow_memory_limit) + " bytes";
    Planner planner(bounds, seen, penumbra, out);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        out.map_of_light.push_back(-1);
        if (!choices[i].boxes.empty()) planner.add(lights[i], choices[i]);
    }
    return out;
}

std::size_t append(ShadowViews& to, ShadowViews&& more) {
    const std::size_t before = to.maps.size();
    to.maps.insert(to.maps.end(), more.maps.begin(), more.maps.end());
    for (const std::size_t first : more.first_texel) to.first_texel.push_back(first + to.texel_count);
    for (const std::size_t first : more.first_wide) to.first_wide.push_back(first + to.wide_count);
    for (ShadowView& view : more.views) {
        view.first_texel += to.texel_count, view.first_wide += to.wide_count;
        to.views.push_back(std::move(view));
    }
    to.texel_count += more.texel_count, to.wide_count += more.wide_count;
    if (!to.warning.empty() && !more.warning.empty()) to.warning += "; ";
    to.warning += more.warning;
    return before;
}

}  // namespace halflit::raster
