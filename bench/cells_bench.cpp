// Whole frames under many lights, with an error budget against exact in turn: 64 spheres under 64 lights, and a floor under 256. 1920 x
// 1080, one sample, no shadows, one thread. The shortest frame of each counts, planning included; the picture is compared with the
// reference.
//
//     halflit_cells_bench [FRAMES [ISA]]      7 frames, the widest instruction set
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

using namespace halflit;
using halflit::test::Random;

namespace {

constexpr int kWidth = 1920, kHeight = 1080;

Camera camera_at(Vec3f place) {
    Camera camera;
    camera.world_from_camera = translation(place);
    camera.fov_y_rad = 0.7f;
    camera.near_z = 0.1f;
    return camera;
}

void add_lamps(Scene& scene, Random& random, int count, Vec3f low, Vec3f high, float strength) {
    for (int i = 0; i < count; ++i) {
        Light light;
        light.type = LightType::point;
        light.position_ws = {random.real32(low.x, high.x), random.real32(low.y, high.y), random.real32(low.z, high.z)};
        light.color_linear = {strength * random.real32(0.3, 1), strength * random.real32(0.3, 1), strength * random.real32(0.3, 1)};
        scene.lights.push_back(light);
    }
}

struct Subject {
    const char* name;
    Scene scene;
    Camera camera;
};

Material material_of(float roughness, const Lobe& lobe) {
    Material material;
    material.base_color = {0.8f, 0.8f, 0.8f, 1};
    material.metallic = 0.0f;
    material.roughness = roughness;
    material.lobe = lobe;
    return material;
}

/// 11 x 6 places, 64 of them taken, that fill the picture.
Subject spheres(const char* name, const Lobe& lobe) {
    Subject subject{name, {}, camera_at({0, 0, 17.5f})};
    Random random(1);
    subject.scene.materials.push_back(material_of(0.6f, lobe));
    Mesh sphere = make_sphere(1.0f, 48, 24);
    sphere.material = 0;
    subject.scene.meshes.push_back(std::move(sphere));
    for (int i = 0; i < 64; ++i)
        subject.scene.instances.push_back(
            {0, translation({2.05f * static_cast<float>(i % 11 - 5), 2.05f * (static_cast<float>(i / 11) - 2.5f), 0})});
    add_lamps(subject.scene, random, 64, {-14, -7, 2.5f}, {14, 7, 9}, 25.0f / 64);
    return subject;
}

Subject floor(const char* name, const Lobe& lobe) {
    Subject subject{name, {}, camera_at({0, 10, 32})};
    Random random(2);
    subject.scene.materials.push_back(material_of(0.9f, lobe));
    Mesh plane = make_plane(32, 32);
    plane.material = 0;
    subject.scene.meshes.push_back(std::move(plane));
    subject.scene.instances.push_back({0, translation({0, 0, 0})});
    add_lamps(subject.scene, random, 256, {-20, 1.5f, -20}, {20, 4, 20}, 6.0f / 64);
    return subject;
}

struct Drawn {
    double ms = 1e30;
    ErrorBound bound;
    double lights_a_pixel = 0;
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
};

bool draw(Renderer& renderer, const Subject& subject, double codes, Accuracy accuracy, std::optional<Isa> isa, Drawn& drawn) {
    Settings settings;
    settings.shadows = ShadowMode::off;
    settings.samples = 1;
    settings.shading.max_error_codes = codes;
    settings.shading.accuracy = accuracy;
    static std::vector<std::uint8_t> pixels(std::size_t{4} * kWidth * kHeight);
    Execution execution{.threads = 1};
    execution.isa = isa;
    const auto report =
        renderer.render(subject.scene, subject.camera, settings, {kWidth, kHeight, pixels.data(), drawn.linear.data()}, execution);
    if (!report) {
        std::fprintf(stderr, "%s: %s\n", subject.name, report.error().message.c_str());
        return false;
    }
    drawn.ms = std::min(drawn.ms, report->total_ms - report->ms.prepare);
    drawn.bound = report->error;
    std::uint64_t lanes = 0;
    for (const std::uint64_t l : report->work.light_lanes) lanes += l;
    drawn.lights_a_pixel = static_cast<double>(lanes) / static_cast<double>(std::max<std::uint64_t>(1, report->fragments_shaded));
    return true;
}

double code_of(float linear) {
    const double v = std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
}

double largest_error(const Drawn& a, const Drawn& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i)
        if (i % 4 != 3 && a.linear[i] != b.linear[i]) most = std::max(most, std::fabs(code_of(a.linear[i]) - code_of(b.linear[i])));
    return most;
}

}  // namespace

int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 7;
    std::optional<Isa> isa;
    for (const Isa one : built_isas())
        if (argc > 2 && isa_name(one) == std::string_view(argv[2])) isa = one;
    if (frames < 1 || (argc > 2 && !isa)) {
        std::fprintf(stderr, "usage: halflit_cells_bench [FRAMES [ISA]]\n");
        return 2;
    }
    const Subject subjects[] = {
        spheres("64 spheres, 64 lights, Lambert", Lobe::lambert()), spheres("64 spheres, 64 lights, sloan 0.3", Lobe::sloan(0.3f)),
        floor("floor, 256 lights, Lambert", Lobe::lambert()), floor("floor, 256 lights, sloan 0.3", Lobe::sloan(0.3f))};
    std::printf("%-34s %7s %9s %7s %9s %9s %11s\n", "scene", "codes", "ms", "ratio", "bound", "measured", "lights/px");
    for (const Subject& subject : subjects) {
        Renderer renderer;
        Drawn truth, drawn[3];
        constexpr double kCodes[] = {0, 0.5, 2};
        if (!draw(renderer, subject, 0, Accuracy::reference, isa, truth)) return 1;
        for (int i = 0; i < frames; ++i)
            for (int k = 0; k < 3; ++k)
                if (!draw(renderer, subject, kCodes[k], Accuracy::exact, isa, drawn[k])) return 1;
        for (int k = 0; k < 3; ++k)
            std::printf("%-34s %7g %9.1f %7.2f %9.3f %9.4f %11.1f\n", subject.name, kCodes[k], drawn[k].ms, drawn[0].ms / drawn[k].ms,
                        drawn[k].bound.codes, largest_error(drawn[k], truth), drawn[k].lights_a_pixel);
    }
    return 0;
}
