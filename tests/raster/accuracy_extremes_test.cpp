// Pictures at the limits of float32: the kernels against the float64 reference, as in the table of extremes in shading/README.md.
// Visibility and interpolated values are the same for both, so the difference comes from shading alone.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr int kWidth = 161, kHeight = 121;  // odd: the picture's middle is the middle of a pixel

struct Subject {
    Scene scene;
    Camera camera;
    float exposure = 1.0f;

    Light& sun() { return scene.lights[0]; }
    Light& lamp() { return scene.lights[1]; }
    void set_lobe(const Lobe& lobe) {
        for (Material& material : scene.materials) material.lobe = lobe;
    }
    void set_lamp(Vec3f position, Vec3f color) {
        lamp().position_ws = position;
        lamp().color_linear = color;
    }
    void set_normal_length(float length) {
        for (Mesh& mesh : scene.meshes)
            for (Vec3f& normal : mesh.normals) normal = normal * length;
    }
    /// Scales all lengths by `size`, and the point light's colour by its square.
    void set_size(float size) {
        for (Mesh& mesh : scene.meshes)
            for (Vec3f& position : mesh.positions) position = position * size;
        for (Instance& instance : scene.instances) {
            Vec4f& place = instance.world_from_object.c[3];
            place = {place.x * size, place.y * size, place.z * size, 1};
        }
        Vec4f& eye = camera.world_from_camera.c[3];
        eye = {eye.x * size, eye.y * size, eye.z * size, 1};
        camera.near_z *= size;
        lamp().position_ws = lamp().position_ws * size;
        lamp().color_linear = lamp().color_linear * size * size;
        lamp().source_radius *= size;
    }
};

/// A ball on a floor under the sun and a point light, with highlights.
Subject usual_subject() {
    Subject s;
    s.camera = test::camera_at({1.5f, 2, 4}, {0, -0.2f, 0}, 0.8f, 0.05f);
    for (int i = 0; i < 2; ++i) {
        Material material;
        material.base_color = i == 0 ? Vec4f{0.9f, 0.6f, 0.3f, 1} : Vec4f{0.5f, 0.7f, 0.9f, 1};
        material.metallic = 0.2f;
        material.roughness = 0.5f;
        material.lobe = Lobe::sloan(0.3f);
        s.scene.materials.push_back(material);
    }
    s.scene.meshes = {make_sphere(1, 48, 32), make_plane(4, 8)};
    for (int i = 0; i < 2; ++i) {
        s.scene.meshes[static_cast<std::size_t>(i)].material = i;
        s.scene.instances.push_back({i, translation({0, i == 0 ? 0.0f : -1.0f, 0})});
    }
    Light sun, lamp;
    sun.direction_ws = {-0.48f, -0.6f, -0.64f};
    sun.color_linear = {0.6f, 0.6f, 0.55f};
    lamp.type = LightType::point;
    lamp.position_ws = {-1.5f, 1.5f, 1.5f};
    lamp.color_linear = {0.4f, 0.5f, 0.8f};
    s.scene.lights = {sun, lamp};
    return s;
}

struct Row {
    const char* name;
    double codes, relative;  ///< bounds on the worst pixel; `relative` is to the picture's largest value, in linear light
    std::function<void(Subject&)> make;
};

const std::vector<Row>& rows() {
    // Sums of a few roundings of float32, 1e-6 relative, and the curves of the highlights, 3e-6. In codes that is at most 112 times as
    // much, at white, where sRGB is most sensitive.
    constexpr double kCodes = 4.5e-4, kRelative = 4e-6;
    constexpr float kUlpBelowOne = 0.99999994f, kUlpAboveZero = 1e-45f;
    static const std::vector<Row> all = {
        {"usual", kCodes, kRelative, [](Subject&) {}},
        {"power 0, a step", kCodes, kRelative,
         [](Subject& s) {
             s.set_lobe({0.5f, 0.0f, false});
         }},
        {"power 1", kCodes, kRelative,
         [](Subject& s) {
             s.set_lobe({0.5f, 1.0f, false});
         }},
        {"power 1.0001", kCodes, kRelative,
         [](Subject& s) {
             s.set_lobe({0.5f, 1.0001f, false});
         }},
        // A power n multiplies the rounding of N.L, 1e-7, by n.
        {"power 10000", 0.1, 1e-3,
         [](Subject& s) {
             s.set_lobe({0.5f, 1e4f, false});
         }},
        {"a = 0", kCodes, kRelative, [](Subject& s) { s.set_lobe(Lobe::sloan(0)); }},
        {"a one ulp above 0", kCodes, kRelative, [](Subject& s) { s.set_lobe(Lobe::sloan(kUlpAboveZero)); }},
        {"a one ulp below 1", kCodes, kRelative, [](Subject& s) { s.set_lobe(Lobe::sloan(kUlpBelowOne)); }},
        {"a = 1", kCodes, kRelative, [](Subject& s) { s.set_lobe(Lobe::sloan(1)); }},
        {"point light on the floor, in a pixel's middle", kCodes, kRelative,
         [](Subject& s) {
             s.lamp().position_ws = {1.2f, -1, 1.6f};
             s.camera = test::camera_at({1.5f, 2, 4}, s.lamp().position_ws, 0.8f, 0.05f);
         }},
        {"the same, radius 0.1", kCodes, kRelative,
         [](Subject& s) {
             s.lamp().position_ws = {1.2f, -1, 1.6f};
             s.lamp().source_radius = 0.1f;
             s.camera = test::camera_at({1.5f, 2, 4}, s.lamp().position_ws, 0.8f, 0.05f);
         }},
        {"point light 1e18 away", kCodes, kRelative,
         [](Subject& s) {
             s.set_lamp({-6e17f, 6e17f, 5e17f}, {4e35f, 5e35f, 8e35f});
         }},
        {"point light 1e19 away", kCodes, kRelative,
         [](Subject& s) {
             s.set_lamp({-6e18f, 6e18f, 5e18f}, {4e37f, 5e37f, 8e37f});
         }},
        {"point light 1e20 away", kCodes, kRelative,
         [](Subject& s) {
             s.set_lamp({-6e19f, 6e19f, 5e19f}, {2e38f, 2.5e38f, 3e38f});
         }},
        {"spot 1e20 away", kCodes, kRelative,
         [](Subject& s) {
             s.set_lamp({-6e19f, 6e19f, 5e19f}, {2e38f, 2.5e38f, 3e38f});
             s.lamp().type = LightType::spot;
             s.lamp().direction_ws = normalize_or({0.6f, -0.5f, -0.5f}, {});
             s.lamp().outer_cone_rad = 0.5f;
             s.lamp().cone_power = 3;
             s.lamp().range = 3e20f;
         }},
        {"light of 1e-20", kCodes, kRelative,
         [](Subject& s) {
             for (Light& light : s.scene.lights) light.color_linear = light.color_linear * 1e-20f;
         }},
        {"light of 1e-20, exposure 1e20", kCodes, kRelative,
         [](Subject& s) {
             for (Light& light : s.scene.lights) light.color_linear = light.color_linear * 1e-20f;
             s.exposure = 1e20f;
         }},
        {"light of 1e20", kCodes, kRelative,
         [](Subject& s) {
             for (Light& light : s.scene.lights) light.color_linear = light.color_linear * 1e20f;
         }},
        {"light of 1e20, exposure 1e-20", kCodes, kRelative,
         [](Subject& s) {
             for (Light& light : s.scene.lights) light.color_linear = light.color_linear * 1e20f;
             s.exposure = 1e-20f;
         }},
        {"normals of length 1e-30", kCodes, kRelative, [](Subject& s) { s.set_normal_length(1e-30f); }},
        {"normals of length 1e30", kCodes, kRelative, [](Subject& s) { s.set_normal_length(1e30f); }},
        {"coordinates of 1e-6", kCodes, kRelative, [](Subject& s) { s.set_size(1e-6f); }},
        {"coordinates of 1e7", kCodes, kRelative, [](Subject& s) { s.set_size(1e7f); }},
    };
    return all;
}

struct Picture {
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(std::size_t{4} * kWidth * kHeight);
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
    RenderReport report;
};

Picture draw(const Subject& subject, Accuracy accuracy, double budget, Isa isa) {
    Picture picture;
    halflit::test::Setup settings;
    settings.execution.isa = isa;
    settings.shadows = ShadowMode::off;
    settings.exposure = subject.exposure;
    settings.shading.accuracy = accuracy;
    settings.shading.max_error_codes = budget;
    const auto report =
        render(subject.scene, subject.camera, settings, {kWidth, kHeight, picture.codes.data(), picture.linear.data()}, settings.execution);
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    picture.report = *report;
    return picture;
}

bool same(const Picture& a, const Picture& b) {
    return a.codes == b.codes && std::memcmp(a.linear.data(), b.linear.data(), a.linear.size() * sizeof(float)) == 0;
}

struct Difference {
    double codes = 0, absolute = 0, largest = 0;
    [[nodiscard]] double relative() const { return absolute / largest; }
};

Difference difference(const Picture& picture, const Picture& truth) {
    Difference d;
    for (std::size_t i = 0; i < truth.linear.size(); ++i) {
        if (i % 4 == 3) continue;
        const double got = picture.linear[i], want = truth.linear[i];
        d.codes = std::max(d.codes, std::fabs(shading::reference::srgb_code(got) - shading::reference::srgb_code(want)));
        d.absolute = std::max(d.absolute, std::fabs(got - want));
        d.largest = std::max(d.largest, std::fabs(want));
    }
    return d;
}

}  // namespace

TEST_CASE("extremes: exact pictures stay close to the reference, finite, and the same on every instruction set", "[raster][accuracy]") {
    std::string table;
    for (const Row& row : rows()) {
        Subject subject = usual_subject();
        row.make(subject);
        const Picture truth = draw(subject, Accuracy::reference, 0, Isa::scalar);
        const Picture exact = draw(subject, Accuracy::exact, 0, Isa::scalar);
        const Difference found = difference(exact, truth);
        char line[160];
        std::snprintf(line, sizeof line, "| %s | %.2g | %.2g | %.2g |\n", row.name, found.largest, found.codes, found.relative());
        table += line;
        INFO(row.name << ": off by " << found.codes << " codes, " << found.relative() << " of " << found.largest);
        CHECK(exact.report.pixels_visible > 5000);
        CHECK(exact.report.nan_pixels == 0);
        CHECK(truth.report.nan_pixels == 0);
        CHECK(std::all_of(exact.linear.begin(), exact.linear.end(), [](float v) { return std::isfinite(v); }));
        CHECK(found.codes <= row.codes);
        CHECK(found.relative() <= row.relative);
        for (const Isa isa : test::available_isas()) {
            INFO(isa_name(isa));
            CHECK(same(draw(subject, Accuracy::exact, 0, isa), exact));
        }
    }
    WARN("largest value, worst error in codes, and relative to that value:\n" << table);
}

TEST_CASE("extremes: a wrap one ulp outside [0, 1] and a power one ulp beyond the largest are refused", "[raster][accuracy]") {
    for (const Lobe& lobe : {Lobe{-1e-45f, 1, false}, Lobe{1.0000001f, 1, false}, Lobe{0.5f, 10000.001f, false}}) {
        Subject subject = usual_subject();
        subject.set_lobe(lobe);
        std::vector<float> linear(std::size_t{4} * kWidth * kHeight);
        CHECK_FALSE(render(subject.scene, subject.camera, {}, {kWidth, kHeight, nullptr, linear.data()}));
    }
}

TEST_CASE("extremes: a budget is kept at the limits of float32 too, the same on every instruction set", "[raster][accuracy]") {
    for (const Row& row : rows()) {
        Subject subject = usual_subject();
        row.make(subject);
        const Picture exact = draw(subject, Accuracy::exact, 0, Isa::scalar);
        for (const double budget : {0.1, 1.0}) {
            const Picture picture = draw(subject, Accuracy::exact, budget, Isa::scalar);
            const double measured = difference(picture, exact).codes;
            const ErrorBound& bound = picture.report.error;
            INFO(row.name << ", budget " << budget << ", bound " << bound.codes << ", measured " << measured);
            CHECK(picture.report.nan_pixels == 0);
            CHECK(bound.codes <= budget);
            CHECK(measured <= bound.codes);
            CHECK(same(draw(subject, Accuracy::exact, budget, test::available_isas().back()), picture));
        }
    }
}
