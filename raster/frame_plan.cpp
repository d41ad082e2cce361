#include "raster/frame_plan.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/scene/surface_distance.hpp"
#include "raster/view/depth_range.hpp"
#include "raster/view/soft_shadows.hpp"
#include "shading/light_cell.hpp"
#include "shading/sky_lights.hpp"

#include <algorithm>
#include <set>

namespace halflit::raster {
namespace {

using shading::LightPlan, shading::MaterialPlan;

/// Options in effect. Accuracy::reference implies light at every pixel, full texture filtering and no error budget.
ShadingSettings effective(ShadingSettings options) {
    if (options.accuracy != Accuracy::reference) return options;
    options.rate = ShadingRate::pixel;
    options.texture_detail = TextureDetail::full;
    options.max_error_codes = 0.0;
    return options;
}

bool all_finite(const Mat4& m) {
    for (const Vec4f& c : m.c)
        for (const float e : {c.x, c.y, c.z, c.w})
            if (!(e > -3e38f && e < 3e38f)) return false;
    return true;
}

shading::Viewer viewer_of(const Camera& camera) {
    const Vec4f back = camera.world_from_camera.c[2], eye = camera.world_from_camera.c[3];
    return {{eye.x, eye.y, eye.z}, normalize_or({-back.x, -back.y, -back.z}, {0, 0, -1}), camera.orthographic};
}

/// Error of a fragment's interpolated position, as a share of the largest coordinate: some ten roundings of float32 on each axis.
constexpr double kPositionError = 1e-6;

/// Facts that an error budget needs of a scene: distances from lights to surfaces, and the largest vertex colour.
shading::SceneFacts scene_facts(const PreparedData& scene, std::span<const LightPlan> lights, FramePlanMemory& memory) {
    shading::SceneFacts facts;
    facts.drawn = scene.drawn_materials();
    facts.vertex_color = scene.largest_color();
    if (memory.geometry_revision != scene.revision().geometry) memory.light_distances.clear();
    memory.geometry_revision = scene.revision().geometry;
    std::map<std::array<double, 3>, double> distances;  // of this plan alone: lights that move all the time must not fill the memory
    const double position_error = kPositionError * largest_coordinate(scene.bounds());
    for (const LightPlan& light : lights) {
        if (memory.stop != nullptr) memory.stop->check();
        if (!kind_of(light.type).placed) {
            facts.light_attenuation.push_back(1.0);
            facts.light_farthest_squared.push_back(0.0);
            continue;
        }
        const Vec3d position{light.position[0], light.position[1], light.position[2]};
        const auto [known, is_new] = distances.try_emplace({position.x, position.y, position.z});
        if (is_new) {
            const auto before = memory.light_distances.find(known->first);
            known->second = before != memory.light_distances.end() ? before->second : nearest_surface_squared(scene, position);
        }
        // Interpolated positions are off by roundings of the coordinates, so a fragment may lie nearer than its triangle.
        const double nearest = std::max(0.0, 0.9995 * __builtin_sqrt(known->second) - position_error);
        facts.light_attenuation.push_back(1.0 / std::max(nearest * nearest, static_cast<double>(light.min_distance_squared)));
        facts.light_farthest_squared.push_back(1.001 * farthest_surface_squared(scene, position));
    }
    memory.light_distances = std::move(distances);
    return facts;
}

/// Environments that drawn materials use, in the plan's order.
std::vector<EnvironmentUse> environment_uses(const PreparedData& scene, const shading::ShadingPlan& plan) {
    std::vector<bool> used(plan.environments.size(), false);
    for (std::size_t i = 0; i < plan.materials.size(); ++i)
        if (scene.drawn_materials()[i] && plan.materials[i].environment >= 0)
            used[static_cast<std::size_t>(plan.materials[i].environment)] = true;
    std::vector<EnvironmentUse> out;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const shading::EnvironmentPlan& environment = plan.environments[i];
        if (used[i]) out.push_back({environment.bands, environment.bound, environment.within});
    }
    return out;
}

/// Adds the warnings about lobes of materials that are drawn and lit, each warning once.
void add_lobe_warnings(const PreparedData& scene, const shading::ShadingPlan& plan, const ShadingSettings& options,
                       std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i < plan.materials.size(); ++i) {
        if (!scene.drawn_materials()[i] || (plan.materials[i].stages & (kStageLights | kStageEnvironment)) == 0) continue;
        std::string warning = lobe_warning(shading::lobe_of(scene.material(i), options));
        if (!warning.empty() && std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
            warnings.push_back(std::move(warning));
    }
}

/// Adds one warning for all meshes that are drawn and lit, but have no normals. ShadingRate::flat takes the triangles' own.
void add_normal_warning(const PreparedData& scene, const shading::ShadingPlan& plan, const ShadingSettings& options,
                        std::vector<std::string>& warnings) {
    if (options.rate == ShadingRate::flat) return;
    std::set<int> meshes;
    int first = -1;
    for (const std::size_t instance : scene.instances_without_normals()) {
        const MaterialPlan& material = plan.materials[scene.material_of(instance)];
        const int index = scene.scene().instances[instance].mesh;
        if ((material.stages & (kStageLights | kStageAmbient | kStageEnvironment)) == 0) continue;
        if (first < 0) first = index;
        meshes.insert(index);
    }
    if (first < 0) return;
    const std::size_t others = meshes.size() - 1;
    std::string warning = "mesh " + std::to_string(first) + " has no normals: its light does not follow its shape";
    if (others > 0) warning += " (and " + std::to_string(others) + (others == 1 ? " other mesh)" : " other meshes)");
    warnings.push_back(std::move(warning));
}

/// The part of the picture that a box may fill, in [-1, 1]; empty if low >= high.
struct PictureBox {
    double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;

    PictureBox(const Bounds& box, const Mat4& clip_from_object) {
        bool any_ahead = false;
        for (int corner = 0; corner < 8; ++corner) {
            const auto at = [corner](int axis, float low, float high) { return double{(corner >> axis & 1) != 0 ? high : low}; };
            const ClipPlace place =
                clip_place(clip_from_object, {at(0, box.min.x, box.max.x), at(1, box.min.y, box.max.y), at(2, box.min.z, box.max.z)});
            const bool ahead = place.w > 0.0;  // a box that reaches behind the camera may fill all
            any_ahead |= ahead;
            low_x = std::min(low_x, ahead ? place.x / place.w : -1.0), high_x = std::max(high_x, ahead ? place.x / place.w : 1.0);
            low_y = std::min(low_y, ahead ? place.y / place.w : -1.0), high_y = std::max(high_y, ahead ? place.y / place.w : 1.0);
        }
        if (!any_ahead) high_x = low_x;
        low_x = std::max(low_x, -1.0), low_y = std::max(low_y, -1.0), high_x = std::min(high_x, 1.0), high_y = std::min(high_y, 1.0);
    }
    [[nodiscard]] bool empty() const { return !(low_x < high_x && low_y < high_y); }
};

/// Whether two of the boxes may overlap. Of many that share columns of the picture, not all pairs are tried.
bool any_overlap(std::vector<PictureBox> boxes) {
    std::sort(boxes.begin(), boxes.end(), [](const PictureBox& a, const PictureBox& b) { return a.low_x < b.low_x; });
    std::size_t pairs = 1000000;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = i + 1; k < boxes.size() && boxes[k].low_x < boxes[i].high_x; ++k)
            if ((boxes[k].low_y < boxes[i].high_y && boxes[i].low_y < boxes[k].high_y) || --pairs == 0) return true;
    return false;
}

/// Adds a warning where several objects are looked through and may lie over one another: one does not show the others.
void add_glass_warning(const PreparedData& scene, const shading::ShadingPlan& plan, const Mat4& clip_from_world,
                       std::vector<std::string>& warnings) {
    std::vector<PictureBox> boxes;
    for (std::size_t i = 0; i < scene.scene().instances.size(); ++i) {
        const Instance& instance = scene.scene().instances[i];
        if (!counts_for_views(scene.scene(), instance) || !plan.materials[scene.material_of(i)].transmission.looked_through) continue;
        const PictureBox box(scene.mesh(instance.mesh).bounds, clip_from_world * instance.world_from_object);
        if (!box.empty()) boxes.push_back(box);
    }
    const std::size_t objects = boxes.size();
    if (any_overlap(std::move(boxes)))
        warnings.push_back(std::to_string(objects) + " objects are of rough or thick glass: one is not seen through another");
}

/// Material plans for the alpha test of the shadow pass; empty if no material has a mask.
std::vector<MaterialPlan> plan_casters(const PreparedData& scene, ShadingSettings options) {
    options.anisotropy = 1;
    std::vector<MaterialPlan> casters;
    for (std::size_t i = 0; i < scene.drawn_materials().size(); ++i) {
        const Material& material = scene.material(i);
        if (!scene.drawn_materials()[i] || material.alpha_mode != AlphaMode::mask) continue;
        casters.resize(scene.drawn_materials().size());
        casters[i] = shading::plan_material(material, scene.scene().textures, scene.available_slots()[i], {}, options);
    }
    return casters;
}

bool uses_cells(const shading::ShadingPlan& plan) {
    return std::any_of(plan.materials.begin(), plan.materials.end(), [](const MaterialPlan& m) { return m.cells.relative > 0.0f; });
}

/// The least region that holds this one and has no square of `side` pixels in part, except at the picture's border.
Region whole_squares(const Region& region, int side, int width, int height) {
    const auto up = [side](int v) { return (v + side - 1) / side * side; };
    const int x = region.x / side * side, y = region.y / side * side;
    return {x, y, std::min(up(region.x + region.width), width) - x, std::min(up(region.y + region.height), height) - y};
}

View picture_view(const Camera& camera, int width, int height, const Region& region, int tile_size, const Settings& settings) {
    View view = make_view(camera, width, height, region, tile_size, settings.samples);
    view.point_size =
        static_cast<int>(__builtin_lrintf((settings.point_size > 0.0f ? settings.point_size : Settings{}.point_size) * 256.0f));
    view.line_width = static_cast<int>(__builtin_lrintf(settings.line_width * 256.0f));
    lift_lines(view, camera, static_cast<double>(settings.line_width));
    return view;
}

/// Sizes by which points close their surface, where the settings leave them to the renderer.
void choose_point_sizes(const PreparedData& scene, const Settings& settings, int width, int height, View& view) {
    if (settings.point_size > 0.0f) return;
    view.point_sizes = closing_point_sizes(scene.scene(), view.clip_from_world, width, height);
    for (const float size : view.point_sizes.size) view.point_size = std::max(view.point_size, static_cast<int>(size));
}

bool has_cloud_without_normals(const PreparedData& scene) {
    const std::span<const std::size_t> instances = scene.instances_without_normals();
    return std::any_of(instances.begin(), instances.end(),
                       [&](std::size_t i) { return is_cloud(scene.source_mesh(scene.scene().instances[i].mesh)); });
}

EyeDomePlan plan_eye_dome(const PreparedData& scene, const Camera& camera, const Settings& settings, const View& view, int width,
                          int height) {
    EyeDomePlan plan;
    if (settings.edl == EyeDomeLighting::off || settings.edl_strength == 0.0f) return plan;
    if (settings.edl == EyeDomeLighting::automatic && !has_cloud_without_normals(scene)) return plan;
    // As far as a point is wide: nearer, depths are those of its own disc, and the steps from disc to disc show instead of the surface.
    constexpr int kMostRadius = 32, kRadiiOfHeight = 256, kUnits = 256;  // units of a pixel
    const int of_points = view.point_sizes.empty() ? view.point_size : view.point_sizes.usual;
    const int radius = has_cloud_without_normals(scene) ? (of_points + kUnits / 2) / kUnits : height / kRadiiOfHeight;
    plan.radius_px = std::clamp(radius, 1, kMostRadius);
    plan.strength = settings.edl_strength / 8.0f;  // of the mean in eight directions
    plan.all = settings.edl == EyeDomeLighting::on;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const DepthMap depth = depth_map(camera, aspect);
    const double pixel = 2.0 * half_extent(camera, aspect) / height;  // at distance 1, or everywhere
    plan.orthographic = camera.orthographic;
    plan.scale = static_cast<float>(camera.orthographic ? 1.0 / (depth.z_scale * pixel) : 1.0 / pixel);
    plan.depth_offset = static_cast<float>(depth.z_scale);
    return plan;
}

/// The region with a border within the picture.
Region with_border(const Region& region, int border, int width, int height) {
    const int x = std::max(region.x - border, 0), y = std::max(region.y - border, 0);
    return {x, y, std::min(region.x + region.width + border, width) - x, std::min(region.y + region.height + border, height) - y};
}

/// The volume that the picture sees, if shadows are looked up there alone. Light at corners or centres of triangles reads them anywhere,
/// and so do look-ups that are moved onto the smooth surface, by up to a triangle's size.
std::optional<SeenVolume> looked_up_where_seen(const PreparedData& scene, const Camera& camera, const ShadingSettings& options,
                                               const Settings& settings, const View& picture) {
    const float aspect = picture.viewport.half_width / picture.viewport.half_height;
    if (settings.shadows == ShadowMode::off || options.rate != ShadingRate::pixel || settings.shadow_terminator_offset) return {};
    return seen_volume(picture, depth_map(camera, aspect), scene.bounds());
}

constexpr int kSkyMapSize = 256;

bool has_sky_shadows(const Lighting& light, const Settings& settings) {
    const bool ambient = light.environment != nullptr || !(light.ambient.sky_linear == Vec3f{} && light.ambient.ground_linear == Vec3f{});
    return settings.sky_shadows != 0 && settings.shadows != ShadowMode::off && ambient;
}

/// The settings for the shadow maps of lights: sky shadows, if there are any, need a part of the memory, at most a half.
Settings beside_sky(const Lighting& light, Settings settings) {
    if (settings.sky_shadows == kSkyShadowsAuto || !has_sky_shadows(light, settings)) return settings;
    const std::size_t needed = static_cast<std::size_t>(settings.sky_shadows) * kSkyMapSize * kSkyMapSize * sizeof(float);
    settings.shadow_memory_limit -= std::min(needed, settings.shadow_memory_limit / 2);
    return settings;
}

/// Directions or grid that stand for the light of the surroundings.
struct SkyPlan {
    std::vector<LightPlan> lights;
    int directions = 0;
    shading::SkyGridPlan grid;
};

/// Lights for sky shadows, with the grid, or with their maps, which are added to `shadows`. Light from all around reaches all of the scene,
/// so its maps are not cut to what is seen.
Result<SkyPlan> plan_sky(const PreparedData& scene, const Lighting& light, const Settings& settings, const ShadowSizes& sizes,
                         ShadowViews& shadows, FramePlanMemory& memory) {
    if (!has_sky_shadows(light, settings)) return SkyPlan{};
    constexpr int kRows = 96, kRowsOfGrid = 16;  // of the cells that are given to the directions
    const bool in_grid = settings.sky_shadows == kSkyShadowsAuto;
    if (in_grid) make_cover_grid(scene, memory.covers);
    if (in_grid && memory.covers.empty()) return SkyPlan{};
    SkyPlan plan;
    plan.directions = in_grid ? shading::kGridDirections : settings.sky_shadows;
    plan.lights = shading::plan_lights(
        shading::sky_lights(plan.directions, in_grid ? kRowsOfGrid : kRows, light.environment.get(), light.ambient, memory.sky_cells));
    if (in_grid) {
        plan.grid = make_sky_grid(memory.covers, plan.lights, *memory.kernels, memory.for_each_row, memory.sky_grid);
        return plan;
    }
    Settings of_sky = settings;
    of_sky.shadow_softness_deg = 0.0f;
    of_sky.shadow_memory_limit -= std::min(of_sky.shadow_memory_limit, shadows.bytes());
    auto views = plan_shadow_views(plan.lights, scene, nullptr, of_sky, {std::min(sizes.most, kSkyMapSize)});
    if (!views) return tl::unexpected<Error>(views.error());
    const std::vector<std::int32_t> maps = views->map_of_light;
    const auto before = static_cast<std::int32_t>(append(shadows, std::move(*views)));
    for (std::size_t i = 0; i < maps.size(); ++i) plan.lights[i].shadow_map = maps[i] < 0 ? -1 : maps[i] + before;
    return plan;
}

bool has_shadow_catcher(const PreparedData& prepared) {
    for (std::size_t i = 0; i < prepared.drawn_materials().size(); ++i)
        if (prepared.drawn_materials()[i] && prepared.material(i).shadow_catcher) return true;
    return false;
}

ContactShadow plan_contact_shadow(const PreparedData& scene, const Camera& camera, const Settings& settings, int width, int height,
                                  FramePlanMemory& memory) {
    if (settings.contact_shadow == 0.0f || settings.shadows == ShadowMode::off || has_shadow_catcher(scene)) return {};
    make_cover_grid(scene, memory.covers);
    make_contact_map(memory.covers, *memory.kernels, memory.for_each_row, memory.contact_map);
    return {memory.contact_map.map, camera, width, height, settings.contact_shadow};
}

Result<FramePlan> make_plan(const PreparedData& prepared, const Lighting& light, const Camera& given, const Settings& settings, int width,
                            int height, int tile_size, FramePlanMemory& memory) {
    if (auto ok = check_settings(settings, width, height); !ok) return tl::unexpected<Error>(ok.error());
    if (auto ok = check_camera(given); !ok) return tl::unexpected<Error>(ok.error());
    if (!prepared.up_to_date()) return fail(ErrorCode::usage, "the last update of the scene failed; no frame is drawn until one succeeds");
    const Scene& scene = prepared.scene();
    ShadingSettings options = effective(settings.shading);
    std::vector<LightPlan> lights = shading::plan_lights(light.all_lights());

    FramePlan plan;
    const Camera camera = plan.camera = drawn_camera(given, prepared);
    plan.options = options;
    // Splats share the budget with the surfaces behind them. What the exact picture leaves out of them counts too.
    // Over nothing, straight colours are divided by an alpha that may be small, so no more is left out there.
    const bool is_opaque = settings.background_environment || settings.background_linear.w >= 1.0f;
    const double for_splats =
        prepared.has_splats() && is_opaque ? options.max_error_codes * (prepared.triangle_count() > 0 ? 0.5 : 1.0) : 0.0;
    options.max_error_codes -= for_splats;
    plan.splat_codes = std::max(0.0, for_splats - 2.0 * kExactSplatCodes);
    plan.picture = picture_view(camera, width, height, settings.region, tile_size, settings);
    choose_point_sizes(prepared, settings, width, height, plan.picture);
    plan.eye_dome = plan_eye_dome(prepared, camera, settings, plan.picture, width, height);
    const std::optional<SeenVolume> seen = looked_up_where_seen(prepared, camera, options, settings, plan.picture);
    const ShadowSizes sizes = shadow_sizes(settings, width, height);
    auto shadows = plan_light_shadows(lights, prepared, seen ? &*seen : nullptr, beside_sky(light, settings), sizes);
    if (!shadows) return tl::unexpected<Error>(shadows.error());
    auto sky = plan_sky(prepared, light, settings, sizes, *shadows, memory);
    if (!sky) return tl::unexpected<Error>(sky.error());
    bool finite_views = all_finite(plan.picture.clip_from_world);
    for (const ShadowView& face : shadows->views) finite_views &= !face.sees_casters || all_finite(face.view.clip_from_world);
    if (!finite_views) return fail(ErrorCode::bad_input, "the camera's matrix is not finite");
    plan.shadow_views = std::move(shadows->views);
    if (memory.shadow_texels && shadows->texel_count > 0) {
        const float* const texels = memory.shadow_texels->reserve(shadows->texel_count + shadows->wide_count, *memory.stop);
        for (std::size_t i = 0; i < shadows->maps.size(); ++i) {
            shadows->maps[i].distance = texels + shadows->first_texel[i];
            shadows->maps[i].wide = texels + shadows->texel_count + shadows->first_wide[i];
        }
        for (ShadowView& face : plan.shadow_views) face.first_wide += shadows->texel_count;
    }

    shading::SceneFacts facts;
    const bool budget = options.max_error_codes > 0.0;
    if (budget) {
        facts = scene_facts(prepared, lights, memory);
        // To read a texel for its range takes some 2 ns; a light that is computed more cheaply saves about an eighth of that a pixel.
        facts.worth_texels = static_cast<double>(width) * height * (0.25 + 0.125 * static_cast<double>(lights.size()));
    }
    plan.shading = shading::plan_shading({.materials = scene.materials,
                                          .textures = scene.textures,
                                          .available_slots = prepared.available_slots(),
                                          .lights = lights,
                                          .ambient = light.ambient,
                                          .options = options,
                                          .environment = light.environment,
                                          .exposure = static_cast<double>(settings.exposure),
                                          .tone_curve = settings.tone_curve,
                                          .viewer = viewer_of(camera),
                                          .shadows = {settings.shadows, settings.shadow_terminator_offset, std::move(shadows->maps),
                                                      std::move(shadows->map_of_light), prepared.object_radii(), std::move(sky->lights),
                                                      sky->directions, sky->grid, static_cast<double>(settings.shadow_fade)},
                                          .facts = budget ? &facts : nullptr,
                                          .drawn = &prepared.drawn_materials(),
                                          .for_each_row = memory.for_each_row,
                                          .looks = prepared.looks()},
                                         memory.shading);
    if (for_splats > 0.0) {
        ErrorBound& error = plan.shading.error;
        error.budget = plan.options.max_error_codes;
        if (plan.splat_codes > 0.0) error.left_out += for_splats, error.codes += for_splats;
    }
    plan.written = plan.picture.region;
    plan.cells = uses_cells(plan.shading);
    for (std::size_t i = 0; i < plan.shading.materials.size(); ++i) {
        const MaterialPlan& material = plan.shading.materials[i];
        if (!prepared.drawn_materials()[i] || (material.stages & kStageTransmission) == 0) continue;
        plan.transmits = true;
        plan.looks_through |= material.transmission.looked_through;
    }
    const bool has_dome = plan.eye_dome.strength > 0.0f;
    if (prepared.has_splats()) plan.splat_squares = whole_squares(plan.written, kSplatTile, width, height);
    const bool has_hidden_splats = prepared.has_splats() && prepared.triangle_count() > 0;
    if (plan.looks_through || plan.cells || has_dome || has_hidden_splats) {
        Region drawn = with_border(plan.written, has_dome ? plan.eye_dome.radius_px : 0, width, height);
        if (plan.cells) drawn = whole_squares(drawn, shading::kCellSide, width, height);
        if (has_hidden_splats) drawn = whole_squares(drawn, kSplatTile, width, height);
        if (plan.looks_through) drawn = {0, 0, width, height};
        set_region(plan.picture, drawn);
    }
    if (!plan.shadow_views.empty()) plan.casters = plan_casters(prepared, options);
    plan.light_culler = LightCuller(plan.shading.lights);
    if (settings.background_environment) {
        if (light.environment == nullptr || light.environment->rgb.empty())
            return fail(ErrorCode::usage, "background_environment: the scene has no environment that kept its image (keep_image)");
        plan.background = Background(*light.environment, camera, width, height, settings.exposure);
    }
    plan.background_linear = settings.background_linear;
    float& alpha = plan.background_linear.w;
    alpha = alpha > 0.0f ? std::min(alpha, 1.0f) : 0.0f;  // an infinite one would make light that is not a number
    plan.contact_shadow = plan_contact_shadow(prepared, camera, settings, width, height, memory);
    plan.exposure = settings.exposure;
    plan.tone_curve = settings.tone_curve;
    plan.depth = depth_map(camera, static_cast<float>(width) / static_cast<float>(height));
    plan.environment_uses = environment_uses(prepared, plan.shading);
    add_lobe_warnings(prepared, plan.shading, options, plan.warnings);
    add_normal_warning(prepared, plan.shading, options, plan.warnings);
    if (plan.looks_through)
        add_glass_warning(prepared, plan.shading, clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height)),
                          plan.warnings);
    add_cut_warning(prepared, camera, plan.picture, plan.warnings);
    if (!shadows->warning.empty()) plan.warnings.push_back(std::move(shadows->warning));
    return plan;
}

}  // namespace

Result<FramePlan> plan_frame(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings, int width,
                             int height, int tile_size, FramePlanMemory& memory) {
    return guarded("planning a frame", {}, [&] { return make_plan(scene, light, camera, settings, width, height, tile_size, memory); });
}

Result<FramePlan> plan_frame(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings, int width,
                             int height, int tile_size) {
    FramePlanMemory memory;
    auto plan = plan_frame(scene, light, camera, settings, width, height, tile_size, memory);
    if (plan) plan->shading.sky_grid.hidden = nullptr;  // it ends with the memory
    return plan;
}

}  // namespace halflit::raster
