#include "apps/engine/answers/pixel_story_text.hpp"

#include "apps/engine/basics/printable.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "shading/material_properties.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::engine {
namespace {

std::string light_numbers(const Rgb3& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v[0], v[1], v[2]); }
std::string place_numbers(Vec3d v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }
std::string weight_numbers(const std::array<double, 3>& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v[0], v[1], v[2]); }

std::string quoted(const std::string& name) { return name.empty() ? "" : " \"" + printable(name) + "\""; }

std::string instance_text(std::size_t instance, const NameOfInstance& name) {
    return fmt::format("instance {}{}", instance, quoted(name ? name(instance) : ""));
}

std::string surface_line(const SurfaceOnRay& hit, const NameOfInstance& name) {
    return fmt::format("triangle {} of mesh {}{}, {}{}", hit.triangle, hit.mesh, quoted(hit.mesh_name), instance_text(hit.instance, name),
                       hit.back ? ", from its back" : "");
}

/// A list of surfaces along the view's ray.
std::string ray_text(const char* title, const std::vector<SurfaceOnRay>& hits, const NameOfInstance& name) {
    if (hits.empty()) return "";
    std::string text = fmt::format("\n{}\n", title);
    for (const SurfaceOnRay& hit : hits) {
        text += "  " + surface_line(hit, name) + "\n";
        text +=
            fmt::format("    at {:.5g} units{}", hit.distance, hit.material_name.empty() ? "" : ", material" + quoted(hit.material_name));
        text += hit.layer ? fmt::format(", a layer of alpha {:.3g}\n", hit.alpha) : "\n";
    }
    return text;
}

/// The material's numbers that differ from those of a plain material, and always base colour, metallic and roughness.
std::string material_text(const PixelStory& story) {
    const Material& material = story.material;
    std::string text = story.material_index < 0 ? std::string("material: the default\n")
                                                : fmt::format("material: {}{}\n", story.material_index, quoted(material.name));
    text += fmt::format("  lobe: wrap {}, power {}{}\n", story.lobe.wrap, story.lobe.power, story.lobe.normalize ? ", normalized" : "");
    const Material plain;
    for (std::size_t row = 0; row < shading::kMaterialNumberCount; ++row) {
        const shading::MaterialNumber& number = shading::kMaterialNumbers[row];
        float values[4] = {}, usual[4] = {};
        number.get(material, values);
        number.get(plain, usual);
        if (row > 2 && std::equal(values, values + number.count, usual)) continue;
        text += fmt::format("  {}:", number.name);
        for (int i = 0; i < number.count; ++i) text += fmt::format(" {:.4g}", values[i]);
        text += '\n';
    }
    text += fmt::format("  alpha mode: {}\n", alpha_mode_name(material.alpha_mode));
    if (material.double_sided) text += "  double-sided\n";
    if (material.unlit) text += "  unlit\n";
    for (const TextureAt& at : story.textures) {
        const shading::TextureSlotInfo& info = shading::info_of(at.slot);
        text += fmt::format("  texture {}: {}, at {:.4f} {:.4f} of set {}\n", info.name, at.texture, at.u, at.v, at.uv_set);
        const auto& c = at.full_size;
        text += fmt::format("    its value there: {:.3f} {:.3f} {:.3f} {:.3f}\n", c[0], c[1], c[2], c[3]);
    }
    return text;
}

std::string surface_text(const PixelStory& story, const NameOfInstance& name) {
    std::string text =
        fmt::format("\nsurface: {} {} of mesh {}{}\n", topology_name(story.topology), story.triangle, story.mesh, quoted(story.mesh_name));
    text += "  " + instance_text(story.instance, name) + "\n";
    if (story.back) text += "  its back is seen\n";
    text += fmt::format("  depth: {:.5g} units\n  position: {}\n", story.depth, place_numbers(story.position));
    text += "  normal: " + place_numbers(story.normal) + "\n";
    for (const Vec3d& corner : story.corners) text += "  corner: " + place_numbers(corner) + "\n";
    if (story.corners.size() == 3) {
        text += "  weights of the corners: " + weight_numbers(story.barycentrics) + "\n";
        text += fmt::format("  position is off the triangle by {:.2g} units\n", story.position_error);
    }
    for (std::size_t set = 0; set < story.uv.size(); ++set)
        text += fmt::format("  texture coordinates {}: {:.4f} {:.4f}\n", set, story.uv[set].x, story.uv[set].y);
    text += "  base colour there: " + light_numbers(story.albedo) + "\n";
    return text + material_text(story);
}

std::string splats_text(const PixelStory& story, const NameOfInstance& name) {
    if (story.splats.empty()) return "";
    std::string text =
        fmt::format("\nGaussians in front, the nearest first; {:.3g} % of the light from behind passes\n", 100.0 * story.splats_passed);
    for (const SplatShare& splat : story.splats)
        text +=
            fmt::format("  {:.4g} %: number {} of mesh {}, {}, alpha {:.4g}, at {:.5g} units, colour {}\n", 100.0 * splat.weight,
                        splat.splat, splat.mesh, instance_text(splat.instance, name), splat.alpha, splat.depth, light_numbers(splat.color));
    if (story.splats_left_out > 0) text += fmt::format("  and {} that show less\n", story.splats_left_out);
    return text;
}

std::string share_text(const LightShare& share, bool surface, const NameOfInstance& name) {
    std::string text = fmt::format("  light {}, {}: {}\n", share.index, kind_of(share.type).name, light_numbers(share.linear));
    if (surface) {
        if (share.distance > 0.0) text += fmt::format("    distance: {:.5g} units\n", share.distance);
        text += fmt::format("    N.L: {:.3f}, lobe: {:.3f}, Lambert: {:.3f}\n", share.cosine, share.lobe, share.lambert);
    }
    text += share.unhidden ? fmt::format("    reaches it: {:.0f} %\n", 100.0 * *share.unhidden) : "    gives no light here\n";
    if (share.hidden_by)
        text += fmt::format("    in its way: {}\n      at {:.5g} units\n", surface_line(*share.hidden_by, name), share.hidden_by->distance);
    return text;
}

std::string light_text(const PixelStory& story, const NameOfInstance& name) {
    std::string text = "\nlinear light, times alpha, mean of all samples (N.L and what is in the way: at the first one)\n";
    for (const LightShare& share : story.shares) text += share_text(share, story.shows == PixelShows::surface, name);
    if (std::any_of(story.shares.begin(), story.shares.end(), [](const LightShare& share) { return share.hidden_by.has_value(); }))
        text += "  (\"in its way\" is by a ray to the light's middle; shadow maps decide the picture)\n";
    if (story.lights_left_out > 0) text += fmt::format("  and {} lights that may give less\n", story.lights_left_out);
    text += "  from all around: " + light_numbers(story.around) + "\n";
    text += "  emitted: " + light_numbers(story.emitted) + "\n";
    return text + "  background: " + light_numbers(story.background) + "\n";
}

std::string error_text(const PixelStory& story) {
    if (!story.no_reference.empty()) return "error against float64: not known: " + printable(story.no_reference) + "\n";
    std::string text = fmt::format("error against float64: {:.2g} {:.2g} {:.2g} codes\n", story.error_codes[0], story.error_codes[1],
                                   story.error_codes[2]);
    text += fmt::format("  float64's codes: {:.2f} {:.2f} {:.2f}\n", story.reference_codes[0], story.reference_codes[1],
                        story.reference_codes[2]);
    if (story.bound_codes > 0.0) text += fmt::format("  bound of the frame: {:.3g} codes\n", story.bound_codes);
    return text;
}

std::string shows_text(const PixelStory& story) {
    const std::string_view behind = story.background_kind == BackgroundKind::transparent ? "transparent"
                                    : story.background_kind == BackgroundKind::color     ? "a colour"
                                                                                         : "the environment";
    if (story.shows == PixelShows::layers) return fmt::format("no surface: layers in front of the background, {}\n", behind);
    if (story.shows == PixelShows::splats) return "3D Gaussians that hide half of what is behind them, or more\n";
    if (story.shows != PixelShows::background) return "";
    const std::string shadow =
        story.contact_shadow > 0.0 ? fmt::format(", in a contact shadow of {:.3g} %", 100.0 * story.contact_shadow) : std::string();
    return fmt::format("no surface: background, {}{}\n", behind, shadow);
}

}  // namespace

std::string story_text(const PixelStory& story, const NameOfInstance& name) {
    const auto& codes = story.codes;
    std::string text = fmt::format("pixel {},{} of {}x{}: #{:02x}{:02x}{:02x}, alpha {}\n", story.x, story.y, story.size.width,
                                   story.size.height, codes[0], codes[1], codes[2], codes[3]);
    text += shows_text(story);
    text += "linear light after exposure: " + light_numbers(story.linear) + "\n";
    text += fmt::format("covered by surfaces: {:.4g} %\n", 100.0 * story.coverage);
    text += error_text(story);
    text += splats_text(story, name);
    text += story.splats.empty() ? light_text(story, name) : std::string("\nthe light of each lamp is not told behind 3D Gaussians\n");
    if (story.shows == PixelShows::surface) text += surface_text(story, name);
    text += ray_text("layers in front, distance from the camera", story.layers, name);
    return text + ray_text("hidden surfaces here, distance from the camera", story.behind, name);
}

}  // namespace halflit::engine
