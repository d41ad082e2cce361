#include "raster/passes/output.hpp"

#include "raster/passes/display_alpha.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace halflit::raster {
namespace {

Result<void> check_plane(const char* name, const void* data, std::size_t row_bytes, std::size_t pixel_bytes, std::size_t alignment,
                         int width) {
    if (data == nullptr) return {};
    if (reinterpret_cast<std::uintptr_t>(data) % alignment != 0)
        return fail(ErrorCode::usage, std::string(name) + ": the memory is not aligned to " + std::to_string(alignment) + " bytes");
    if (row_bytes == 0) return {};
    const std::size_t row = pixel_bytes * static_cast<std::size_t>(width);
    if (row_bytes < row)
        return fail(ErrorCode::usage, std::string(name) + ": rows of " + std::to_string(row_bytes) + " bytes, expected at least " +
                                          std::to_string(row) + " for " + std::to_string(width) + " pixels");
    if (row_bytes > std::numeric_limits<std::int32_t>::max())
        return fail(ErrorCode::usage, std::string(name) + ": rows of " + std::to_string(row_bytes) + " bytes, expected at most 2^31 - 1");
    if (row_bytes % alignment != 0)
        return fail(ErrorCode::usage, std::string(name) + ": rows of " + std::to_string(row_bytes) + " bytes, expected a multiple of " +
                                          std::to_string(alignment));
    return {};
}

/// Code times alpha, rounded.
std::uint32_t times(std::uint32_t code, std::uint32_t alpha) { return (code * alpha + 127u) / 255u; }

}  // namespace

Result<void> check_target(const Target& target, const Region& region) {
    if (target.format != PixelFormat::rgba8 && target.format != PixelFormat::bgra8)
        return fail(ErrorCode::usage, "pixel format: expected rgba8 or bgra8, found " + std::to_string(static_cast<int>(target.format)));
    const int width = target.region_alone && region.width > 0 ? region.width : target.width;
    const struct {
        const char* name;
        const void* data;
        std::size_t row_bytes, pixel_bytes, alignment;
    } planes[] = {{"pixels", target.pixels, target.row_bytes, 4, 1},
                  {"linear", target.linear, target.linear_row_bytes, 16, alignof(float)},
                  {"depth", target.depth, target.depth_row_bytes, 4, alignof(float)},
                  {"normal", target.normal, target.normal_row_bytes, 12, alignof(float)},
                  {"instance", target.instance, target.instance_row_bytes, 4, alignof(std::uint32_t)},
                  {"triangle", target.triangle, target.triangle_row_bytes, 4, alignof(std::uint32_t)},
                  {"shading_normal", target.shading_normal, target.shading_normal_row_bytes, 12, alignof(float)},
                  {"albedo", target.albedo, target.albedo_row_bytes, 12, alignof(float)},
                  {"position", target.position, target.position_row_bytes, 12, alignof(float)},
                  {"lights", target.lights, target.lights_row_bytes, 4, alignof(std::uint32_t)},
                  {"coverage", target.coverage, target.coverage_row_bytes, 4, alignof(float)},
                  {"barycentric", target.barycentric, target.barycentric_row_bytes, 8, alignof(float)},
                  {"uv", target.uv, target.uv_row_bytes, 8, alignof(float)}};
    for (const auto& plane : planes)
        if (auto ok = check_plane(plane.name, plane.data, plane.row_bytes, plane.pixel_bytes, plane.alignment, width); !ok) return ok;
    return {};
}

Output::Output(const Target& target, const Region& region, bool display_alpha)
    : as_they_are_(target.format == PixelFormat::rgba8 && !target.premultiplied && !display_alpha),
      bgra_(target.format == PixelFormat::bgra8),
      premultiplied_(target.premultiplied),
      display_alpha_(display_alpha) {
    const int width = target.region_alone ? region.width : target.width;
    const int x0 = target.region_alone ? region.x : 0, y0 = target.region_alone ? region.y : 0;
    codes = {target.pixels, target.row_bytes, 4, width, x0, y0};
    linear = {target.linear, target.linear_row_bytes, 4, width, x0, y0};
    depth = {target.depth, target.depth_row_bytes, 1, width, x0, y0};
    normal = {target.normal, target.normal_row_bytes, 3, width, x0, y0};
    instance = {target.instance, target.instance_row_bytes, 1, width, x0, y0};
    triangle = {target.triangle, target.triangle_row_bytes, 1, width, x0, y0};
    shading_normal = {target.shading_normal, target.shading_normal_row_bytes, 3, width, x0, y0};
    albedo = {target.albedo, target.albedo_row_bytes, 3, width, x0, y0};
    position = {target.position, target.position_row_bytes, 3, width, x0, y0};
    lights = {target.lights, target.lights_row_bytes, 1, width, x0, y0};
    coverage = {target.coverage, target.coverage_row_bytes, 1, width, x0, y0};
    barycentric = {target.barycentric, target.barycentric_row_bytes, 2, width, x0, y0};
    uv = {target.uv, target.uv_row_bytes, 2, width, x0, y0};
}

void Output::finish_codes(std::uint32_t* codes_of_pixels, int count) const {
    if (as_they_are_) return;
    for (int i = 0; i < count; ++i) {
        std::uint8_t rgba[4];
        std::memcpy(rgba, codes_of_pixels + i, 4);
        if (display_alpha_) set_display_alpha(rgba);
        if (premultiplied_)
            for (int c = 0; c < 3; ++c) rgba[c] = static_cast<std::uint8_t>(times(rgba[c], rgba[3]));
        if (bgra_) std::swap(rgba[0], rgba[2]);
        std::memcpy(codes_of_pixels + i, rgba, 4);
    }
}

void Output::read_code(int x, int y, double (&rgba)[4]) const {
    std::uint8_t code[4];
    std::memcpy(code, codes.at(x, y), 4);
    if (bgra_) std::swap(code[0], code[2]);
    rgba[3] = code[3] / 255.0;
    for (int c = 0; c < 3; ++c)
        rgba[c] = premultiplied_ && code[3] > 0 ? std::min(1.0, code[c] / static_cast<double>(code[3])) : code[c] / 255.0;
}

void Output::write_code(int x, int y, const double (&rgba)[4]) const {
    std::uint8_t code[4];
    for (int c = 0; c < 4; ++c) {
        const double value = premultiplied_ && c < 3 ? rgba[c] * rgba[3] : rgba[c];
        code[c] = static_cast<std::uint8_t>(value * 255.0 + 0.5);
    }
    if (bgra_) std::swap(code[0], code[2]);
    std::memcpy(codes.at(x, y), code, 4);
}

}  // namespace halflit::raster
