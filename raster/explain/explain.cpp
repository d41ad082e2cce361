#include "halflit/explain.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/explain/ray_hits.hpp"
#include "raster/explain/splat_shares.hpp"
#include "raster/scene/instance_material.hpp"
#include "raster/view/depth_range.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "shading/material_properties.hpp"
#include "shading/plan/lobe_plan.hpp"
#include "shading/reference/reference.hpp"
#include "shading/reference/tone.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace halflit {

using namespace raster;

namespace {

double brightest(const Rgb3& c) { return std::max({c[0], c[1], c[2]}); }

Rgb3 difference(const Rgb3& a, const Rgb3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Codes before they are rounded.
Rgb3 codes_of(ToneCurve curve, const Rgb3& linear) {
    const Vec3d shown = shading::reference::toned(curve, {linear[0], linear[1], linear[2]});
    return {shading::reference::srgb_code(shown.x), shading::reference::srgb_code(shown.y), shading::reference::srgb_code(shown.z)};
}

/// The planes of one pixel.
struct PixelPlanes {
    float depth = 0, coverage = 0;
    std::uint32_t instance = 0, triangle = 0;
    std::array<float, 3> normal{}, albedo{}, position{};
};

/// Result of drawing one pixel: light, multiplied by alpha if asked for, and alpha.
struct DrawnPixel {
    Rgb3 linear{};
    double alpha = 0;
    std::array<int, 4> codes{};
    RenderReport report;
};

/// Draws one pixel of a picture, and tells its story.
class PixelProbe {
public:
    PixelProbe(Renderer& renderer, const PreparedScene& scene, const Lighting& light, const Camera& camera, const Settings& settings,
               PictureSize size, int x, int y, const Execution& execution)
        : renderer_(renderer),
          prepared_(scene),
          light_(light),
          camera_(drawn_camera(camera, scene.data())),
          settings_(settings),
          execution_(execution) {
        settings_.region = {x, y, 1, 1};
        execution_.on_tile = {}, execution_.progress = {};
        story_.x = x, story_.y = y, story_.size = size;
    }

    Result<PixelStory> tell() {
        PixelPlanes planes;
        const auto drawn = draw(light_, settings_, false, &planes);
        if (!drawn) return tl::unexpected(drawn.error());
        story_.codes = drawn->codes, story_.linear = drawn->linear, story_.alpha = drawn->alpha;
        story_.bound_codes = drawn->report.error.budget > 0.0 ? drawn->report.error.codes : 0.0;
        tell_surface(planes);
        tell_ray();
        if (data().has_splats()) tell_splats(data(), camera_, depth_of_surface(), story_);
        tell_error();
        if (!story_.splats.empty()) return std::move(story_);
        if (const auto told = tell_lights(); !told) return tl::unexpected(told.error());
        return std::move(story_);
    }

private:
    [[nodiscard]] const PreparedData& data() const { return prepared_.data(); }
    [[nodiscard]] const Scene& scene() const { return prepared_.scene(); }

    Result<DrawnPixel> draw(const Lighting& light, const Settings& settings, bool premultiplied, PixelPlanes* planes = nullptr) {
        std::array<float, 4> linear{};
        std::array<std::uint8_t, 4> codes{};
        Target target{story_.size.width, story_.size.height, codes.data(), linear.data()};
        target.region_alone = true;
        target.premultiplied = premultiplied;
        if (planes != nullptr) {
            target.depth = &planes->depth;
            target.coverage = &planes->coverage;
            target.instance = &planes->instance;
            target.triangle = &planes->triangle;
            target.shading_normal = planes->normal.data();
            target.albedo = planes->albedo.data();
            target.position = planes->position.data();
        }
        auto report = renderer_.render(prepared_, light, camera_, settings, target, execution_);
        if (!report) return tl::unexpected(report.error());
        DrawnPixel out;
        for (std::size_t i = 0; i < 3; ++i) out.linear[i] = double{linear[i]};
        out.alpha = double{linear[3]};
        std::copy(codes.begin(), codes.end(), out.codes.begin());
        out.report = std::move(*report);
        return out;
    }

    void tell_surface(const PixelPlanes& planes) {
        story_.coverage = double{planes.coverage};
        story_.background_kind = settings_.background_environment        ? BackgroundKind::environment
                                 : settings_.background_linear.w == 0.0f ? BackgroundKind::transparent
                                                                         : BackgroundKind::color;
        if (planes.instance == 0 || planes.triangle == 0) return;
        story_.shows = PixelShows::surface;
        if (scene().meshes[static_cast<std::size_t>(scene().instances[planes.instance - 1].mesh)].splats != nullptr) {
            story_.shows = PixelShows::splats;
            return;
        }
        const auto vector = [](const std::array<float, 3>& v) { return to_double(Vec3f{v[0], v[1], v[2]}); };
        story_.depth = double{planes.depth};
        story_.position = vector(planes.position);
        story_.normal = vector(planes.normal);
        std::copy(planes.albedo.begin(), planes.albedo.end(), story_.albedo.begin());
        story_.instance = planes.instance - 1;
        story_.triangle = planes.triangle - 1;
        const Instance& instance = scene().instances[story_.instance];
        story_.mesh = static_cast<std::size_t>(instance.mesh);
        const Mesh& mesh = scene().meshes[story_.mesh];
        story_.mesh_name = mesh.name;
        story_.topology = mesh.topology;
        story_.material_index = material_index(scene(), instance);
        story_.material = data().material(data().material_of(story_.instance));
        story_.lobe = shading::lobe_of(story_.material, settings_.shading);
        const std::size_t corners = corners_of(mesh.topology);
        for (std::size_t i = story_.triangle * corners; i < std::min(mesh.indices.size(), (story_.triangle + 1) * corners); ++i)
            story_.corners.push_back(to_double(transform_point(instance.world_from_object, mesh.positions[mesh.indices[i]])));
        if (mesh.topology == Topology::triangles && story_.corners.size() == 3) tell_place_in_triangle(mesh, instance);
    }

    /// Barycentric coordinates of the foot of the perpendicular from the position, and what is interpolated by them.
    void tell_place_in_triangle(const Mesh& mesh, const Instance& instance) {
        const Vec3d a = story_.corners[0], b = story_.corners[1], c = story_.corners[2], p = story_.position;
        const Vec3d normal = cross(b - a, c - a);
        const double square = dot(normal, normal);
        if (!(square > 0.0)) return;
        const double weights[3] = {dot(cross(c - b, p - b), normal) / square, dot(cross(a - c, p - c), normal) / square,
                                   dot(cross(b - a, p - a), normal) / square};
        // Rounding may leave the triangle by a little.
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) sum += story_.barycentrics[k] = clamped(weights[k], 0.0, 1.0);
        for (double& weight : story_.barycentrics) weight /= sum;
        const auto& w = story_.barycentrics;
        story_.position_error = length(p - ((a * w[0] + b * w[1]) + c * w[2]));
        const Vec3d to_eye = camera_.orthographic ? axis(camera_.world_from_camera, 2) : axis(camera_.world_from_camera, 3) - p;
        story_.back = (dot(normal, to_eye) < 0.0) != (determinant3(instance.world_from_object) < 0.0);
        if (!mesh.uv0.empty() || !mesh.uv1.empty())
            for (int set = 0; set < (mesh.uv1.empty() ? 1 : 2); ++set)
                story_.uv.push_back((set == 1 ? mesh.uv1 : mesh.uv0).empty() ? Vec2<double>{} : uv_at(mesh, set, story_.triangle, w));
        for (const TextureSlot slot : shading::kAllTextureSlots)
            if (const auto texture = texture_at(scene(), mesh, story_.material, slot, story_.triangle, w))
                story_.textures.push_back(*texture);
    }

    void tell_ray() {
        if (story_.shows != PixelShows::surface) {
            const Ray ray = ray_of_pixel(camera_, story_.size, story_.x, story_.y);
            story_.layers = hits_along(data(), ray, RaySees::layers, kMostSurfaces);
            if (!story_.layers.empty() && story_.shows == PixelShows::background) story_.shows = PixelShows::layers;
            if (story_.shows == PixelShows::splats) {
                story_.behind = hits_along(data(), ray, RaySees::drawn, kMostSurfaces + story_.layers.size());
                std::erase_if(story_.behind, [](const SurfaceOnRay& hit) { return hit.layer; });
            }
            return;
        }
        const Ray ray = ray_to(camera_, story_.size, story_.position);
        const TriangleOfInstance self{story_.instance, story_.triangle};
        const double distance = dot(story_.position - ray.origin, ray.direction), slack = larger(1e-6 * absolute(distance), rounding());
        Ray front = ray, rest = ray, here = ray;
        front.most = here.least = distance - slack;
        rest.least = here.most = distance + slack;
        story_.layers = hits_along(data(), front, RaySees::layers, kMostSurfaces, self);
        story_.behind = hits_along(data(), rest, RaySees::drawn, kMostSurfaces, self);
        const CoplanarGroups& groups = data().coplanar();
        const std::uint32_t group = groups.empty() ? 0 : groups.of(story_.instance, story_.triangle);
        if (group == 0) return;
        std::vector<SurfaceOnRay> plane = hits_along(data(), here, RaySees::drawn, kMostSurfaces, self);
        std::erase_if(plane, [&](const SurfaceOnRay& hit) { return groups.of(hit.instance, hit.triangle) != group; });
        // From the eye on: layers, the last one first, and what the surface hides.
        std::sort(plane.begin(), plane.end(), [&](const SurfaceOnRay& a, const SurfaceOnRay& b) {
            const auto order = [&](const SurfaceOnRay& hit) {
                const std::size_t rank = hit.layer ? hit.instance : std::size_t{groups.rank(data().material_of(hit.instance))};
                return std::tuple(hit.layer, rank, hit.instance, hit.triangle);
            };
            return order(a) > order(b);
        });
        const auto hidden = std::find_if(plane.begin(), plane.end(), [](const SurfaceOnRay& hit) { return !hit.layer; });
        story_.layers.insert(story_.layers.end(), plane.begin(), hidden);
        story_.behind.insert(story_.behind.begin(), hidden, plane.end());
        if (story_.layers.size() > kMostSurfaces) story_.layers.resize(kMostSurfaces);
        if (story_.behind.size() > kMostSurfaces) story_.behind.resize(kMostSurfaces);
    }

    /// Along the view axis; infinite: there is none.
    [[nodiscard]] double depth_of_surface() const {
        if (story_.shows == PixelShows::surface) return story_.depth;
        if (story_.behind.empty()) return std::numeric_limits<double>::infinity();
        return -dot(story_.behind[0].position - axis(camera_.world_from_camera, 3), axis(camera_.world_from_camera, 2));
    }

    /// Bound on the rounding of the position to float32, world units: some units in the last place of the largest coordinate.
    [[nodiscard]] double rounding() const {
        double largest = 0.0;
        const auto add = [&](Vec3d p) { largest = std::max({largest, absolute(p.x), absolute(p.y), absolute(p.z)}); };
        add(story_.position);
        for (const Vec3d corner : story_.corners) add(corner);
        return 0x1p-21 * largest;
    }

    void tell_error() {
        Settings settings = settings_;
        settings.shading.max_error_codes = 0.0;
        settings.shading.accuracy = Accuracy::reference;
        const auto reference = draw(light_, settings, false);
        if (!reference) {
            story_.no_reference = reference.error().message;
            return;
        }
        // The curve is for each sample, and a background colour, unlit surfaces and lines have none: the mean light has the picture's codes
        // by one curve, or by none.
        Rgb3 shown{};
        for (std::size_t i = 0; i < 3; ++i) shown[i] = double(story_.codes[i]), story_.reference_codes[i] = double(reference->codes[i]);
        for (const ToneCurve curve : {settings_.tone_curve, ToneCurve::none}) {
            const Rgb3 own = codes_of(curve, story_.linear), apart = difference(own, shown);
            if (std::any_of(apart.begin(), apart.end(), [](double x) { return absolute(x) > 0.51; })) continue;
            shown = own, story_.reference_codes = codes_of(curve, reference->linear);
            break;
        }
        const Rgb3 error = difference(shown, story_.reference_codes);
        for (std::size_t i = 0; i < 3; ++i) story_.error_codes[i] = absolute(error[i]);
    }

    struct RankedLight {
        bool out_of_range;  ///< at the position; it may reach other samples and layers
        double strength;    ///< the most that it can give there
        std::size_t index;
    };

    /// Lights that are not black, the strongest at the point first, those out of range last.
    [[nodiscard]] std::vector<RankedLight> ranked(const std::vector<Light>& lights) const {
        const bool one_place = settings_.samples == 1 && story_.layers.empty();
        std::vector<RankedLight> order;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const Light& light = lights[i];
            RankedLight rank{false, double{std::max({light.color_linear.x, light.color_linear.y, light.color_linear.z})}, i};
            if (kind_of(light.type).placed && story_.shows == PixelShows::surface) {
                const double distance = length(to_double(light.position_ws) - story_.position);
                rank.out_of_range = light.range > 0.0f && distance > double{light.range};
                rank.strength /= larger(distance * distance, 1e-8);
            }
            if (rank.strength > 0.0 && !(rank.out_of_range && one_place)) order.push_back(rank);
        }
        std::stable_sort(order.begin(), order.end(), [](const RankedLight& a, const RankedLight& b) {
            return a.out_of_range != b.out_of_range ? b.out_of_range : a.strength > b.strength;
        });
        return order;
    }

    void tell_geometry(const Light& light, LightShare& share) const {
        if (story_.shows != PixelShows::surface) return;
        Vec3d to_light = to_double(light.direction_ws) * -1.0;
        if (kind_of(light.type).placed) {
            to_light = to_double(light.position_ws) - story_.position;
            share.distance = length(to_light);
        }
        const double size = length(to_light);
        if (!(size > 0.0)) return;
        to_light = to_light * (1.0 / size);
        share.cosine = dot(story_.normal, to_light);
        share.lobe = shading::reference::lobe_value(story_.lobe, share.cosine);
        share.lambert = larger(0.0, share.cosine);
        Ray ray{story_.position, to_light, rounding()};
        if (kind_of(light.type).placed) ray.most = share.distance;
        const auto hits = hits_along(data(), ray, RaySees::casters, 1, TriangleOfInstance{story_.instance, story_.triangle});
        if (!hits.empty()) share.hidden_by = hits[0];
    }

    /// Each part of the light by itself, in front of black.
    Result<void> tell_lights() {
        Settings settings = settings_;
        settings.background_linear = {0, 0, 0, 0};
        settings.background_environment = false;
        Rgb3 whole = story_.linear;
        for (double& channel : whole) channel *= story_.alpha;
        const auto before_black = draw(light_, settings, true);
        if (!before_black) return tl::unexpected(before_black.error());
        story_.background = difference(whole, before_black->linear);
        if (settings.contact_shadow > 0.0f) {
            Settings without = settings;
            without.contact_shadow = 0.0f;
            const auto drawn = draw(light_, without, true);
            if (!drawn) return tl::unexpected(drawn.error());
            if (drawn->alpha < 1.0) story_.contact_shadow = (before_black->alpha - drawn->alpha) / (1.0 - drawn->alpha);
        }
        settings.shading.max_error_codes = 0.0;
        Lighting around = light_;
        around.lights.clear(), around.suns = false;
        const auto part = [&](const Lighting& light, Rgb3& linear) -> Result<void> {
            const auto drawn = draw(light, settings, true);
            if (!drawn) return tl::unexpected(drawn.error());
            linear = difference(drawn->linear, story_.emitted);
            return {};
        };
        if (const auto drawn = part({}, story_.emitted); !drawn) return drawn;
        if (const auto drawn = part(around, story_.around); !drawn) return drawn;
        const std::vector<Light> lights = light_.all_lights();
        const std::vector<RankedLight> order = ranked(lights);
        const std::size_t told = std::min(order.size(), kMostShares);
        story_.lights_left_out = order.size() - told;
        for (std::size_t k = 0; k < told; ++k) {
            LightShare share;
            share.index = order[k].index;
            Lighting one;
            one.lights = {lights[share.index]};
            share.type = one.lights[0].type;
            Rgb3 open{};
            settings.shadows = ShadowMode::off;
            const auto drawn_open = part(one, open);
            settings.shadows = settings_.shadows;
            if (!drawn_open) return drawn_open;
            if (brightest(open) > 0.0) {
                if (const auto drawn = part(one, share.linear); !drawn) return drawn;
                share.unhidden = clamped(brightest(share.linear) / brightest(open), 0.0, 1.0);
            } else if (order[k].out_of_range) {
                continue;
            }
            tell_geometry(one.lights[0], share);
            story_.shares.push_back(share);
        }
        std::stable_sort(story_.shares.begin(), story_.shares.end(),
                         [](const LightShare& a, const LightShare& b) { return brightest(a.linear) > brightest(b.linear); });
        return {};
    }

    Renderer& renderer_;
    const PreparedScene& prepared_;
    const Lighting& light_;
    const Camera camera_;
    Settings settings_;
    Execution execution_;
    PixelStory story_;
};

}  // namespace

Result<PixelStory> explain_pixel(Renderer& renderer, const PreparedScene& scene, const Lighting& light, const Camera& camera,
                                 const Settings& settings, PictureSize size, int x, int y, const Execution& execution) {
    return guarded("explaining a pixel", execution, [&]() -> Result<PixelStory> {
        if (x < 0 || y < 0 || x >= size.width || y >= size.height)
            return fail(ErrorCode::usage, "pixel " + std::to_string(x) + "," + std::to_string(y) + ": outside of the " +
                                              std::to_string(size.width) + "x" + std::to_string(size.height) + " picture");
        return PixelProbe(renderer, scene, light, camera, settings, size, x, y, execution).tell();
    });
}

}  // namespace halflit
