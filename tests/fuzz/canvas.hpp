// Memory of a picture, and what every picture promises.
#pragma once

#include "tests/fuzz/render_flags.hpp"

#include "halflit/target.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace halflit::fuzz {

/// Pixels and, with flags.planes, all planes; between rows lies memory that must not be touched.
struct Canvas {
    static constexpr std::uint8_t kUntouched = 0xA5;

    Bytes pixels;
    std::vector<float> linear, depth, normal, shading_normal, albedo, position, coverage, barycentric, uv;
    std::vector<std::uint32_t> instance, triangle, lights;
    Target target;

    explicit Canvas(const RenderFlags& flags) {
        const std::size_t width = static_cast<std::size_t>(flags.width), height = static_cast<std::size_t>(flags.height);
        target.width = flags.width;
        target.height = flags.height;
        target.row_bytes = 4 * (width + flags.padding);
        pixels.assign(target.row_bytes * height, kUntouched);
        target.pixels = pixels.data();
        target.format = flags.bgra ? PixelFormat::bgra8 : PixelFormat::rgba8;
        target.premultiplied = flags.premultiplied;
        if (!flags.planes) return;
        linear.assign(4 * width * height, 0.0f);
        depth.assign(width * height, 0.0f);
        normal.assign(3 * width * height, 0.0f);
        instance.assign(width * height, 0);
        triangle.assign(width * height, 0);
        for (auto* plane : {&shading_normal, &albedo, &position}) plane->assign(3 * width * height, 0.0f);
        coverage.assign(width * height, 0.0f);
        lights.assign(width * height, 0);
        for (auto* plane : {&barycentric, &uv}) plane->assign(2 * width * height, 0.0f);
        target.barycentric = barycentric.data();
        target.uv = uv.data();
        target.shading_normal = shading_normal.data();
        target.albedo = albedo.data();
        target.position = position.data();
        target.coverage = coverage.data();
        target.lights = lights.data();
        target.linear = linear.data();
        target.depth = depth.data();
        target.normal = normal.data();
        target.instance = instance.data();
        target.triangle = triangle.data();
    }
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// By bits, NaN included.
    [[nodiscard]] bool same_as(const Canvas& other) const {
        const auto same = [](const auto& a, const auto& b) {
            return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
        };
        return same(pixels, other.pixels) && same(linear, other.linear) && same(depth, other.depth) && same(normal, other.normal) &&
               same(instance, other.instance) && same(triangle, other.triangle) && same(shading_normal, other.shading_normal) &&
               same(albedo, other.albedo) && same(position, other.position) && same(coverage, other.coverage) &&
               same(lights, other.lights) && same(barycentric, other.barycentric) && same(uv, other.uv);
    }

    /// Nothing outside of the region is written, no NaN anywhere, and numbers are those of the scene.
    void check(const Region& region, const Scene& scene) const {
        const auto is_untouched = [](std::uint8_t b) { return b == kUntouched; };
        for (int y = 0; y < target.height; ++y)
            for (int x = 0; x < static_cast<int>(target.row_bytes / 4); ++x) {
                const bool inside = region.width == 0
                                        ? x < target.width
                                        : x >= region.x && x < region.x + region.width && y >= region.y && y < region.y + region.height;
                const std::uint8_t* pixel =
                    pixels.data() + static_cast<std::size_t>(y) * target.row_bytes + static_cast<std::size_t>(4 * x);
                HALFLIT_PROMISE(inside || std::all_of(pixel, pixel + 4, is_untouched));
            }
        for (const auto* plane : {&linear, &depth, &normal, &shading_normal, &albedo, &position, &coverage, &barycentric, &uv})
            for (const float value : *plane) HALFLIT_PROMISE(!std::isnan(value));
        for (std::size_t i = 0; i < instance.size(); ++i) {
            HALFLIT_PROMISE(barycentric[2 * i] >= 0.0f && barycentric[2 * i + 1] >= 0.0f &&
                            barycentric[2 * i] + barycentric[2 * i + 1] <= 1.000001f);
            HALFLIT_PROMISE(lights[i] <= scene.lights.size() && coverage[i] >= 0.0f && coverage[i] <= 1.0f);
            HALFLIT_PROMISE(instance[i] <= scene.instances.size() && (instance[i] == 0) == (triangle[i] == 0));
            if (instance[i] == 0) continue;
            const int mesh = scene.instances[instance[i] - 1].mesh;
            const Mesh& shown = scene.meshes[static_cast<std::size_t>(mesh)];
            HALFLIT_PROMISE(triangle[i] <= shown.indices.size() / corners_of(shown.topology));
        }
    }
};

}  // namespace halflit::fuzz
