#include "raster/choice/suited_background.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/mean_color.hpp"
#include "sh/equirect.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 16;  ///< triangles, lines or points that are looked at
/// At a silhouette: the light that smooth and rough metals mirror to the eye, divided by what a white surface scatters.
constexpr double kSmoothMirrors = 0.54, kRoughMirrors = 0.55;
/// sRGB codes of the usual background, and of that behind dark surfaces.
constexpr int kDarkBackground[] = {0x2c, 0x30, 0x36}, kLightBackground[] = {0xb4, 0xba, 0xc2};
/// Edges of models with this luminance come out as about 105 codes, between the two backgrounds.
constexpr double kDark = 0.165;

/// A sum of what is given back, by area.
struct Mean {
    double sum = 0, weight = 0;
    void add(double luminance, double by) { sum += luminance * by, weight += by; }
};

/// Light that a material sends to the eye under white light, where vertices and instances are white.
struct SurfaceLight {
    Vec3d back;        ///< of that light
    Vec3d own{};       ///< emission
    double alpha = 1;  ///< of a blended material's colour
};

SurfaceLight light_of(const Scene& scene, const Material* material) {
    if (material == nullptr) return {{kRoughMirrors, kRoughMirrors, kRoughMirrors}};
    const auto mean = [&](TextureSlot slot) { return to_double(mean_color(scene, material->textures[slot])); };
    const auto share = [](float factor, double of_texture) { return std::clamp(double{factor} * of_texture, 0.0, 1.0); };
    const Vec3d color = mean(TextureSlot::base_color), metal = mean(TextureSlot::metallic_roughness), own = mean(TextureSlot::emissive);
    const double mirrored = kSmoothMirrors + (kRoughMirrors - kSmoothMirrors) * share(material->roughness, metal.y);
    const double part = material->unlit ? 1.0 : 1.0 - (1.0 - mirrored) * share(material->metallic, metal.z);
    SurfaceLight light;
    light.back = Vec3d{material->base_color.x * color.x, material->base_color.y * color.y, material->base_color.z * color.z} * part;
    // What is seen through glass is the background: it is its reflections that have to stand out.
    if (material->transmits()) light.back = light.back * (1.0 - share(material->transmission, mean(TextureSlot::transmission).x));
    if (!material->unlit) light.own = {material->emissive.x * own.x, material->emissive.y * own.y, material->emissive.z * own.z};
    if (material->alpha_mode == AlphaMode::blend) light.alpha = share(material->base_color.w, 1.0);
    return light;
}

}  // namespace

double surface_luminance(const Scene& scene) {
    std::size_t elements = 0;
    const auto each_mesh = [&](const auto& visit) {
        for (const Instance& instance : scene.instances) {
            if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) continue;
            if (counts_for_views(scene, instance)) visit(instance, scene.meshes[static_cast<std::size_t>(instance.mesh)]);
        }
    };
    each_mesh([&](const Instance&, const Mesh& mesh) { elements += mesh.indices.size() / corners_of(mesh.topology); });
    const std::size_t stride = elements / kMostElements + 1;
    Mean triangles, others;
    std::size_t next = 0;  // element of the mesh that is looked at
    TimeCheck check;
    each_mesh([&](const Instance& instance, const Mesh& mesh) {
        check();
        const std::size_t corners = corners_of(mesh.topology), count = mesh.indices.size() / corners;
        const SurfaceLight surface = light_of(scene, material_of(scene, instance));
        for (; next < count; next += stride) {
            const std::uint32_t* const corner = &mesh.indices[next * corners];
            // The scene is not checked yet.
            if (!std::all_of(corner, corner + corners, [&](std::uint32_t vertex) { return vertex < mesh.positions.size(); })) continue;
            const Vec4f color = corner[0] < mesh.colors.size() ? mesh.colors[corner[0]] : Vec4f{1, 1, 1, 1};
            const Vec3d light{surface.back.x * color.x * instance.color.x, surface.back.y * color.y * instance.color.y,
                              surface.back.z * color.z * instance.color.z};
            const double luminance = std::clamp(sh::luminance(light + surface.own), 0.0, 1.0);
            if (corners < 3) {
                others.add(luminance, surface.alpha);
                continue;
            }
            const auto at = [&](std::size_t c) {
                return to_double(transform_point(instance.world_from_object, mesh.positions[corner[c]]));
            };
            const double area = length(cross(at(1) - at(0), at(2) - at(0)));
            if (area < 1e100) triangles.add(luminance, area * surface.alpha);  // false for what is not a number
        }
        next -= std::min(next, count);
    });
    const Mean& mean = triangles.weight > 0.0 ? triangles : others;
    return mean.weight > 0.0 && mean.sum == mean.sum ? mean.sum / mean.weight : 0.5;
}

Vec4f suited_background(const Scene& scene) {
    const auto& code = surface_luminance(scene) < kDark ? kLightBackground : kDarkBackground;
    const auto linear = [&](int channel) { return static_cast<float>(shading::linear_from_srgb(code[channel] / 255.0)); };
    return {linear(0), linear(1), linear(2), 1.0f};
}

}  // namespace halflit::raster
