// The caller's memory as tiles write it: rows, strides, the order of bytes, premultiplied alpha.
#pragma once

#include "halflit/settings.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::raster {

/// Fails (usage) for a stride that is smaller than a row, and for memory or a stride that is not aligned.
[[nodiscard]] Result<void> check_target(const Target& target, const Region& region);

/// One plane: `channels` values of type T a pixel, addressed by the picture's coordinates.
template <class T>
class Plane {
public:
    Plane() = default;
    /// `row_bytes` 0: rows of `width` pixels follow one another. (x0, y0): the picture's pixel that lies at `data`.
    Plane(T* data, std::size_t row_bytes, int channels, int width, int x0, int y0)
        : data_(data),
          row_bytes_(row_bytes != 0 ? row_bytes : sizeof(T) * static_cast<std::size_t>(channels) * static_cast<std::size_t>(width)),
          channels_(channels),
          x0_(x0),
          y0_(y0) {}

    explicit operator bool() const { return data_ != nullptr; }
    [[nodiscard]] T* at(int x, int y) const {
        char* row = reinterpret_cast<char*>(data_) + static_cast<std::size_t>(y - y0_) * row_bytes_;
        return reinterpret_cast<T*>(row) + static_cast<std::ptrdiff_t>(channels_) * (x - x0_);
    }

private:
    T* data_ = nullptr;
    std::size_t row_bytes_ = 0;
    int channels_ = 1, x0_ = 0, y0_ = 0;
};

class Output {
public:
    /// `region`: the pixels that are drawn, never empty. display_alpha: codes get an alpha for blends of codes (display_alpha.hpp).
    Output(const Target& target, const Region& region, bool display_alpha = false);

    /// Turns straight RGBA codes into those that the target holds, in place.
    void finish_codes(std::uint32_t* codes_of_pixels, int count) const;
    /// A pixel's codes / 255, straight, and its alpha, as they were written; and writes them.
    void read_code(int x, int y, double (&rgba)[4]) const;
    void write_code(int x, int y, const double (&rgba)[4]) const;
    /// Writes one pixel, from straight linear RGBA.
    void write_linear(int x, int y, float red, float green, float blue, float alpha) const {
        const float factor = premultiplied_ ? alpha : 1.0f;
        float* p = linear.at(x, y);
        p[0] = red * factor;
        p[1] = green * factor;
        p[2] = blue * factor;
        p[3] = alpha;
    }

    [[nodiscard]] bool is_premultiplied() const { return premultiplied_; }

    Plane<std::uint8_t> codes;
    Plane<float> linear, depth, normal, shading_normal, albedo, position, coverage, barycentric, uv;
    Plane<std::uint32_t> instance, triangle, lights;
    /// Colours are asked for. Otherwise nothing is shaded, and no light is looked at.
    [[nodiscard]] bool has_colors() const { return codes || linear; }
    [[nodiscard]] bool has_planes() const { return depth || instance || coverage || has_triangle() || has_surface(); }
    /// Planes that need the number of the triangle in its mesh.
    [[nodiscard]] bool has_triangle() const { return triangle || barycentric || uv; }
    /// Planes of what is interpolated or read from textures.
    [[nodiscard]] bool has_surface() const { return normal || has_material(); }
    [[nodiscard]] bool has_material() const { return shading_normal || albedo || position || lights; }

private:
    bool as_they_are_;  ///< codes are copied
    bool bgra_, premultiplied_, display_alpha_;
};

}  // namespace halflit::raster
