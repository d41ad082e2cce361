#include "bench/peer/gl_shaders.hpp"

#include "bench/peer/scenes.hpp"
#include "halflit/environment.hpp"
#include "shading/environment.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/model/scalar.hpp"
#include "shading/plan/environment_plans.hpp"
#include "shading/reflection_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace halflit::peer {
namespace {

constexpr const char* kHead = R"(#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
)";

constexpr const char* kVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_world;
invariant gl_Position;
out vec3 v_position;
out vec3 v_normal;
#ifdef TEXTURED
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
out vec4 v_tangent;
out vec2 v_uv;
#endif
#ifdef PLANES
layout(location = 4) in uint code;
layout(location = 5) in vec3 label;
flat out uint v_code;
out vec3 v_weights;
#endif
void main() {
    gl_Position = clip_from_world * vec4(position, 1.0);
    v_position = position;
    v_normal = normal;
#ifdef TEXTURED
    v_tangent = tangent;
    v_uv = uv;
#endif
#ifdef PLANES
    v_code = code;
    v_weights = label;
#endif
}
)";

constexpr const char* kPlanes = R"(
flat in uint v_code;
in vec3 v_weights;
layout(location = 1) out uint triangle;
layout(location = 2) out float depth;
layout(location = 3) out vec2 weights;
void write_planes() {
    triangle = v_code >> 4u;
    depth = 1.0 / gl_FragCoord.w;
    uint second = v_code & 3u, third = (v_code >> 2u) & 3u;
    weights.x = second == 0u ? v_weights.x : second == 1u ? v_weights.y : v_weights.z;
    weights.y = third == 0u ? v_weights.x : third == 1u ? v_weights.y : v_weights.z;
}
)";

constexpr const char* kFragment = R"(
in vec3 v_position;
in vec3 v_normal;
#ifdef TEXTURED
in vec4 v_tangent;
in vec2 v_uv;
uniform sampler2D base_color_texture;
uniform sampler2D normal_texture;
#endif
uniform sampler2D around_map;
uniform float around_turned;
uniform vec3 lamp_position[LAMPS];
uniform vec3 lamp_color[LAMPS];
uniform vec3 eye;
layout(location = 0) out vec4 color;

// Three bands of spherical harmonics as a polynomial in the direction's components.
#define SERIES(name, n) \
    max(((n[0] * (name.z - 0.5) + n[1]) * name.z + n[2]) + (n[3] * name.z + n[5]) * name.x + (n[4] * name.z + n[6]) * name.y + \
        n[7] * (name.x * name.x - name.y * name.y) + n[8] * (2.0 * name.x * name.y), vec3(0.0))

void add_light(vec3 direction, float attenuation, vec3 light, vec3 normal, vec3 to_eye, inout vec3 diffuse, inout vec3 highlight) {
    float n_dot_l = dot(normal, direction);
    float t = clamp((n_dot_l + WRAP) * (1.0 / (1.0 + WRAP)), 0.0, 1.0);
    diffuse += light * (t * sqrt(t) * attenuation);
    vec3 between = direction + to_eye;
    float cosine = max(dot(normal, between), 0.0) * inversesqrt(dot(between, between));
    highlight += light * (max(n_dot_l, 0.0) * POWER(cosine) * attenuation);
}

// The environment's maps lie one below the other; a row holds two times ROWS and one values.
vec3 blurred(int level, vec2 at) {
    vec2 place = vec2(at.x * 2.0 * kRows[level], at.y * kRows[level] + kFirst[level]) + 0.5;
    return texture(around_map, place / vec2(textureSize(around_map, 0))).rgb;
}
vec3 mirrored(vec3 d, float level) {
    vec2 at = vec2(fract(atan(d.x, -d.z) * 0.159154943 + 0.5 + around_turned), atan(length(d.xz), d.y) * 0.318309886);
    int fine = int(min(floor(level), LAST_LEVEL - 1.0));
    return mix(blurred(fine, at), blurred(fine + 1, at), level - float(fine));
}

void main() {
    vec3 normal = normalize(v_normal);
    vec3 base = BASE;
#ifdef TEXTURED
    base *= texture(base_color_texture, v_uv).rgb;
    vec3 tangent = normalize(v_tangent.xyz);
    vec3 mapped = 2.0 * texture(normal_texture, v_uv).rgb - 1.0;
    normal = normalize(tangent * mapped.x + cross(normal, tangent) * v_tangent.w * mapped.y + normal * mapped.z);
#endif
    vec3 to_eye = normalize(eye - v_position);
    vec3 diffuse = vec3(0.0), highlight = vec3(0.0);
    for (int i = 0; i < LAMPS; ++i) {
        vec3 offset = lamp_position[i] - v_position;
        float squared = dot(offset, offset);
        add_light(offset * inversesqrt(squared), 1.0 / max(squared, LEAST_SQUARED), lamp_color[i], normal, to_eye, diffuse, highlight);
    }
    SUNS
    vec3 f0 = vec3(DIELECTRIC), albedo = base * (1.0 - DIELECTRIC);
    float n_dot_v = dot(normal, to_eye), seen = clamp(n_dot_v, 0.0, 1.0), node = 18.0 * seen / (seen + 0.2);
    vec3 reflection = 2.0 * n_dot_v * normal - to_eye;
    int low = int(min(floor(node), 14.0));
    vec4 shape = mix(kMirror[low], kMirror[low + 1], node - float(low));  // A, B, turn, level
    float share = (shape.x * DIELECTRIC + shape.y) * (1.0 + DIELECTRIC * (1.0 / (shape.x + shape.y) - 1.0));
    vec3 around = base * (1.0 - share) * SERIES(normal, kDiffuse) +
        share * mirrored(reflection + (normal - n_dot_v * reflection) * shape.z, shape.w);
    color = vec4(albedo * diffuse + f0 * highlight * NORMALIZATION + around, 1.0);
#ifdef PLANES
    write_planes();
#endif
}
)";

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9e", value);
    return text;
}
std::string vec3(Vec3f v) { return "vec3(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")"; }

void define(std::string& text, const char* name, const std::string& value) {
    text += "#define ";
    text += name;
    text += " " + value + "\n";
}

/// A function that raises to a whole power by squares.
std::string raised(int exponent) {
    std::string text = "float raised(float x) {\n    float product = 1.0;\n";
    for (; exponent > 0; exponent >>= 1) {
        if (exponent & 1) text += "    product *= x;\n";
        text += "    x *= x;\n";
    }
    return text + "    return product;\n}\n";
}

std::string series(const char* name, const shading::EnvironmentPlan& plan) {
    std::string text = std::string("const vec3 ") + name + "[9] = vec3[9](";
    for (std::size_t i = 0; i < 9; ++i)
        text += (i > 0 ? ", " : "") + vec3({plan.newton[3 * i], plan.newton[3 * i + 1], plan.newton[3 * i + 2]});
    return text + ");\n";
}

shading::EnvironmentPlan plan(const Environment& environment, const sh::WrapLobe& lobe) {
    shading::EnvironmentOrder order;
    order.fixed = kEnvironmentBands;
    return shading::plan_environment(environment, lobe, order);
}

/// The table of mirrors at one roughness, for one lobe, and the places of the environment's maps.
std::string mirror_constants(float roughness) {
    using shading::kReflectionNodes, shading::ReflectionShape;
    const double row = double{roughness} * (kReflectionNodes - 1);
    const int low = std::min(static_cast<int>(row), kReflectionNodes - 2);
    std::string text = "const vec4 kMirror[16] = vec4[16](";
    static_assert(kReflectionNodes == 16);
    for (int j = 0; j < kReflectionNodes; ++j) {
        const ReflectionShape &a = shading::kReflectionShapes[low * kReflectionNodes + j],
                              &b = shading::kReflectionShapes[(low + 1) * kReflectionNodes + j];
        const auto between = [&](float first, float second) { return number(first + (row - low) * (double{second} - first)); };
        text += (j > 0 ? ", vec4(" : "vec4(") + between(a.a, b.a) + ", " + between(a.b, b.b) + ", " + between(a.turn0, b.turn0) + ", " +
                between(a.level0, b.level0) + ")";
    }
    return text + ");\nuniform float kRows[8];\nuniform float kFirst[8];\n";
}

}  // namespace

ShaderSources shader_sources(const Scene& scene, PeerOutputs outputs, bool products) {
    static_assert(kEnvironmentBands == 3);
    const Material& material = scene.materials[0];
    const bool textured = material.textures[TextureSlot::base_color].used();
    const float roughness = std::max(material.roughness, shading::kMinRoughness);
    const double half_exponent = half_specular_exponent(double{roughness});
    const auto lamps = std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.type == LightType::point; });

    std::string head = kHead;
    if (textured) define(head, "TEXTURED", "1");
    if (outputs != PeerOutputs::colour) define(head, "PLANES", "1");
    define(head, "LAMPS", std::to_string(lamps));
    define(head, "WRAP", number(material.lobe.wrap));
    const double exponent = 2 * half_exponent;
    const bool is_whole = exponent == std::floor(exponent) && exponent < 1024;
    if (products && is_whole) head += raised(static_cast<int>(exponent));
    define(head, "POWER(x)", products && is_whole ? "raised(x)" : "pow(x, " + number(exponent) + ")");
    define(head, "NORMALIZATION", number(specular_normalization(half_exponent, false)));
    define(head, "BASE", vec3({material.base_color.x, material.base_color.y, material.base_color.z}));
    define(head, "DIELECTRIC", number(material.dielectric_reflectance));
    define(head, "LEAST_SQUARED", number(double{shading::kMinSourceRadius} * double{shading::kMinSourceRadius}));
    std::string suns;
    for (const Light& sun : environment_suns(*scene.environment))
        suns +=
            "add_light(" + vec3(sun.direction_ws * -1.0f) + ", 1.0, " + vec3(sun.color_linear) + ", normal, to_eye, diffuse, highlight); ";
    define(head, "SUNS", suns);
    const sh::WrapLobe lobe{material.lobe.wrap, material.lobe.power, material.lobe.scale()};
    define(head, "LAST_LEVEL", number(shading::kReflectionLevels - 1));
    const std::string light = series("kDiffuse", plan(*scene.environment, lobe)) + mirror_constants(roughness);
    const std::string planes = outputs == PeerOutputs::colour ? "" : kPlanes;
    const std::string fragment = outputs == PeerOutputs::planes ? "void main() { write_planes(); }\n" : light + kFragment;
    return {head + kVertex, head + planes + fragment, head + "void main() {}\n"};
}

}  // namespace halflit::peer
