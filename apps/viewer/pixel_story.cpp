#include "apps/viewer/pixel_story.hpp"

#include "sh/vec3d.hpp"
#include "shading/plan/lobe_plan.hpp"
#include "shading/reference/reference.hpp"
#include "shading/reference/tone.hpp"

#include <algorithm>
#include <utility>

namespace halflit::viewer {
namespace {

double brightest(const Rgb3& c) { return std::max({c[0], c[1], c[2]}); }

Rgb3 difference(const Rgb3& a, const Rgb3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Codes before they are rounded.
Rgb3 codes_of(ToneCurve curve, const Rgb3& linear) {
    const Vec3d shown = shading::reference::toned(curve, {linear[0], linear[1], linear[2]});
    return {shading::reference::srgb_code(shown.x), shading::reference::srgb_code(shown.y), shading::reference::srgb_code(shown.z)};
}

/// The planes of one pixel.
struct Planes {
    float depth = 0, coverage = 0;
    std::uint32_t instance = 0, triangle = 0;
    std::array<float, 3> normal{}, albedo{}, position{};
};

/// Draws one pixel of a job.
class Probe {
public:
    Probe(cli::RenderJob& job, Renderer& renderer, int x, int y) : job_(job), renderer_(renderer), settings_(job.settings) {
        settings_.region = {x, y, 1, 1};
    }

    [[nodiscard]] Settings& settings() { return settings_; }

    Result<RenderReport> draw(Rgb3& linear, std::array<int, 4>* codes = nullptr, Planes* planes = nullptr) {
        std::array<float, 4> light{};
        std::array<std::uint8_t, 4> pixel{};
        Target target{job_.width, job_.height, pixel.data(), light.data()};
        target.region_alone = true;
        if (planes != nullptr) {
            target.depth = &planes->depth;
            target.coverage = &planes->coverage;
            target.instance = &planes->instance;
            target.triangle = &planes->triangle;
            target.shading_normal = planes->normal.data();
            target.albedo = planes->albedo.data();
            target.position = planes->position.data();
        }
        auto report = renderer_.render(*job_.prepared, job_.light, job_.camera, settings_, target, job_.timed_execution());
        for (std::size_t i = 0; i < 3; ++i) linear[i] = static_cast<double>(light[i]);
        if (codes != nullptr) std::copy(pixel.begin(), pixel.end(), codes->begin());
        return report;
    }

private:
    cli::RenderJob& job_;
    Renderer& renderer_;
    Settings settings_;
};

/// Changes the light that is drawn; what it was comes back at the end.
class LightSwitch {
public:
    explicit LightSwitch(cli::RenderJob& job) : job_(job), started_(job.light), lights_(job.light.all_lights()) {}
    ~LightSwitch() { job_.light = started_; }
    LightSwitch(const LightSwitch&) = delete;
    LightSwitch& operator=(const LightSwitch&) = delete;

    /// around: with ambient light and environment.
    void set(std::vector<Light> lights, bool around) {
        job_.light = around ? started_ : Lighting{};
        job_.light.lights = std::move(lights);
        job_.light.suns = false;
    }
    [[nodiscard]] const std::vector<Light>& lights() const { return lights_; }

private:
    cli::RenderJob& job_;
    Lighting started_;
    std::vector<Light> lights_;  ///< suns too
};

void tell_surface(const cli::RenderJob& job, const Planes& planes, PixelStory& story) {
    story.hit = planes.instance > 0 && planes.triangle > 0;
    story.depth = static_cast<double>(planes.depth);
    story.coverage = static_cast<double>(planes.coverage);
    if (!story.hit) return;
    const auto vector = [](const std::array<float, 3>& v) { return to_double(Vec3f{v[0], v[1], v[2]}); };
    story.position = vector(planes.position);
    story.normal = vector(planes.normal);
    std::copy(planes.albedo.begin(), planes.albedo.end(), story.albedo.begin());
    const Scene& scene = job.scene();
    story.instance = planes.instance - 1;
    story.triangle = planes.triangle - 1;
    const Instance& instance = scene.instances[story.instance];
    story.mesh = static_cast<std::size_t>(instance.mesh);
    const Mesh& mesh = scene.meshes[story.mesh];
    story.mesh_name = mesh.name;
    story.topology = mesh.topology;
    const Material unnamed;
    const Material& material = mesh.material < 0 ? unnamed : scene.materials[static_cast<std::size_t>(mesh.material)];
    story.material = material.name;
    story.lobe = shading::lobe_of(material, job.settings.shading);
    const std::size_t corners = corners_of(mesh.topology);
    for (std::size_t i = story.triangle * corners; i < std::min(mesh.indices.size(), (story.triangle + 1) * corners); ++i) {
        const Vec3f p = mesh.positions[mesh.indices[i]];
        const Vec4f at = instance.world_from_object * Vec4f{p.x, p.y, p.z, 1.0f};
        story.corners.push_back(to_double(Vec3f{at.x, at.y, at.z}));
    }
}

/// Lights by the most that they can give at the point, black ones and those out of range left out.
std::vector<std::size_t> lights_by_strength(const std::vector<Light>& lights, const PixelStory& story) {
    std::vector<std::pair<double, std::size_t>> strengths;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = lights[i];
        const double color = static_cast<double>(std::max({light.color_linear.x, light.color_linear.y, light.color_linear.z}));
        double strength = color;
        if (kind_of(light.type).placed && story.hit) {
            const double distance = length(to_double(light.position_ws) - story.position);
            if (light.range > 0.0f && distance > static_cast<double>(light.range)) continue;
            strength = color / std::max(distance * distance, 1e-8);
        }
        if (strength > 0.0) strengths.emplace_back(-strength, i);
    }
    std::sort(strengths.begin(), strengths.end());
    std::vector<std::size_t> order;
    for (const auto& [strength, i] : strengths) order.push_back(i);
    return order;
}

void tell_geometry(const Light& light, const PixelStory& story, LightShare& share) {
    Vec3d to_light = to_double(light.direction_ws) * -1.0;
    if (kind_of(light.type).placed) {
        to_light = to_double(light.position_ws) - story.position;
        share.distance = length(to_light);
    }
    const double size = length(to_light);
    if (!story.hit || !(size > 0.0)) return;
    share.cosine = dot(story.normal, to_light) * (1.0 / size);
    share.lobe = shading::reference::lobe_value(story.lobe, share.cosine);
    share.lambert = std::max(0.0, share.cosine);
}

Result<void> tell_lights(cli::RenderJob& job, Probe& probe, PixelStory& story) {
    // Each part of the light by itself, in front of black.
    Settings& settings = probe.settings();
    settings.shading.max_error_codes = 0.0;
    settings.background_linear = {0, 0, 0, 1};
    settings.background_environment = false;
    LightSwitch light(job);
    const auto part = [&](const std::vector<Light>& lights, bool around, Rgb3& linear) -> Result<void> {
        light.set(lights, around);
        const auto drawn = probe.draw(linear);
        if (!drawn) return tl::unexpected(drawn.error());
        return {};
    };
    if (const auto drawn = part({}, false, story.emitted); !drawn) return drawn;
    if (const auto drawn = part({}, true, story.around); !drawn) return drawn;
    story.around = difference(story.around, story.emitted);
    const std::vector<std::size_t> order = lights_by_strength(light.lights(), story);
    story.lights_left_out = order.size() - std::min(order.size(), kMostShares);
    const ShadowMode shadows = settings.shadows;
    for (std::size_t k = 0; k < std::min(order.size(), kMostShares); ++k) {
        const Light& one = light.lights()[order[k]];
        LightShare share;
        share.index = order[k];
        share.type = one.type;
        tell_geometry(one, story, share);
        if (const auto drawn = part({one}, false, share.linear); !drawn) return drawn;
        share.linear = difference(share.linear, story.emitted);
        Rgb3 open{};
        settings.shadows = ShadowMode::off;
        const auto drawn = part({one}, false, open);
        settings.shadows = shadows;
        if (!drawn) return drawn;
        open = difference(open, story.emitted);
        if (brightest(open) > 0.0) share.unhidden = std::clamp(brightest(share.linear) / brightest(open), 0.0, 1.0);
        story.shares.push_back(share);
    }
    std::stable_sort(story.shares.begin(), story.shares.end(),
                     [](const LightShare& a, const LightShare& b) { return brightest(a.linear) > brightest(b.linear); });
    return {};
}

}  // namespace

Result<PixelStory> tell_pixel(cli::RenderJob& job, Renderer& renderer, int x, int y) {
    PixelStory story;
    story.x = x;
    story.y = y;
    Probe probe(job, renderer, x, y);
    Planes planes;
    const auto drawn = probe.draw(story.sum, &story.codes, &planes);
    if (!drawn) return tl::unexpected(drawn.error());
    story.bound_codes = drawn->error.budget > 0.0 ? drawn->error.codes : 0.0;
    tell_surface(job, planes, story);

    const Settings as_drawn = probe.settings();
    probe.settings().shading.max_error_codes = 0.0;
    probe.settings().shading.accuracy = Accuracy::reference;
    Rgb3 truth{};
    if (const auto reference = probe.draw(truth)) {
        story.reference_codes = codes_of(job.settings.tone_curve, truth);
        const Rgb3 error = difference(codes_of(job.settings.tone_curve, story.sum), story.reference_codes);
        for (std::size_t i = 0; i < 3; ++i) story.error_codes[i] = absolute(error[i]);
    } else {
        story.no_reference = reference.error().message;
    }
    probe.settings() = as_drawn;
    if (const auto told = tell_lights(job, probe, story); !told) return tl::unexpected(told.error());
    return story;
}

}  // namespace halflit::viewer
