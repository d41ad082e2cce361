// Output of shaded fragments: exposure, samples, the background, the mean of a pixel's samples, sRGB codes, the caller's pixels.
#include "raster/passes/picture_tile.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::raster {
namespace {

/// 0 for NaN, x for everything else; 0 instead of -0, as a sum of samples is.
float number_or_zero(float x) { return x == x ? x + 0.0f : 0.0f; }

Vec4f number_or_zero(Vec4f v) { return {number_or_zero(v.x), number_or_zero(v.y), number_or_zero(v.z), number_or_zero(v.w)}; }

/// Colour of a pixel, the mean of its samples, not premultiplied. sum: light times alpha, and alpha, summed over the samples. weight:
/// 1 / number of samples. Sums and quotients of infinite samples may be NaN; that becomes 0.
Vec4f resolved(const float (&sum)[4], float weight) {
    const float alpha = sum[3] * weight;
    if (!(alpha > 0.0f)) return {0, 0, 0, number_or_zero(alpha)};
    return number_or_zero(Vec4f{sum[0] * weight / alpha, sum[1] * weight / alpha, sum[2] * weight / alpha, alpha});
}

}  // namespace

Vec4f PictureTile::background_sample() const {
    if (pass_.view.behind) return {0, 0, 0, 0};
    const Vec4f b = number_or_zero(plan_.background_linear);
    return {b.x * b.w, b.y * b.w, b.z * b.w, b.w};
}

void PictureTile::clear() {
    if (direct_) {
        fill_background();
        return;
    }
    float* color = scratch_.color.reserve(static_cast<std::size_t>(samples_) * 4 * kTilePixels);
    const Vec4f back = background_sample();
    for (int i = 0; i < samples_ * kTilePixels; ++i) std::memcpy(color + 4 * i, &back, sizeof back);
    fill_backing(1.0f);
    if (has_background()) fill_samples();
}

void PictureTile::write(const FragmentList& list, const shading::FragmentBlock& block) {
    if (!direct_) {
        write_samples(list, block);
        return;
    }
    const Output& output = pass_.output;
    const bool is_display = is_shown(list.material);
    const float exposure = exposure_of(list.material);
    if (output.codes) {
        alignas(64) std::uint32_t code[shading::kBlockSize];
        if (toned_ && !is_display) {
            alignas(64) float shown[3][shading::kBlockSize];
            const float* const light[3] = {block.red, block.green, block.blue};
            float* const display[3] = {shown[0], shown[1], shown[2]};
            tone(light, exposure, display, list.count);
            pass_.view.shade.encode_srgb8(shown[0], shown[1], shown[2], block.alpha, 1.0f, code, list.count);
        } else {
            pass_.view.shade.encode_srgb8(block.red, block.green, block.blue, block.alpha, exposure, code, list.count);
        }
        output.finish_codes(code, list.count);
        // Neighbours in a row are copied together.
        for (int l = 0, end = 0; l < list.count; l = end) {
            const int x = list.x_px[l], y = list.y_px[l];
            for (end = l + 1; end < list.count && list.y_px[end] == y && list.x_px[end] == x + (end - l);) ++end;
            const int from = std::max(x, written_.x), to = std::min(x + (end - l), written_.x + written_.width);
            if (from < to && y >= written_.y && y < written_.y + written_.height)
                std::memcpy(output.codes.at(from, y), &code[l + (from - x)], 4 * static_cast<std::size_t>(to - from));
        }
    }
    if (output.linear)
        for (int l = 0; l < list.count; ++l) {
            if (!is_written(list.x_px[l], list.y_px[l])) continue;
            output.write_linear(list.x_px[l], list.y_px[l], number_or_zero(block.red[l] * exposure),
                                number_or_zero(block.green[l] * exposure), number_or_zero(block.blue[l] * exposure),
                                number_or_zero(block.alpha[l]));
        }
}

Vec4f PictureTile::light_of(const shading::FragmentBlock& block, int lane, float exposure) {
    const float a = number_or_zero(block.alpha[lane]);
    return {number_or_zero(block.red[lane] * exposure) * a, number_or_zero(block.green[lane] * exposure) * a,
            number_or_zero(block.blue[lane] * exposure) * a, a};
}

void PictureTile::write_samples(const FragmentList& list, const shading::FragmentBlock& block) {
    const bool shown = toned_ && is_shown(list.material);
    if (shown) begin_shown();
    const float exposure = exposure_of(list.material);
    for (int l = 0; l < list.count; ++l) {
        const Vec4f light = light_of(block, l, exposure);
        const int at = (list.y_px[l] - rect_.y) * kTileStride + (list.x_px[l] - rect_.x);
        for (auto samples = static_cast<unsigned>(list.samples[l]); samples != 0; samples &= samples - 1)
            std::memcpy(sample_color(__builtin_ctz(samples)) + 4 * at, &light, sizeof light);
        cover_backing(at, static_cast<unsigned>(list.samples[l]), 1.0f);
        if (shown) add_shown(at, static_cast<unsigned>(list.samples[l]), light);
    }
}

void PictureTile::fill_samples() {
    fill_backing(0.0f);  // an environment is light, as a surface's is
    for (int y = 0; y < rect_.height; ++y)
        for (int x = 0; x < rect_.width; ++x) {
            const Vec4f b = number_or_zero(plan_.background.at(rect_.x + x, rect_.y + y));
            for (int s = 0; s < samples_; ++s) std::memcpy(sample_color(s) + 4 * (y * kTileStride + x), &b, sizeof b);
        }
}

void PictureTile::fill_background() {
    if (has_background()) {
        // Goes through samples, so that an empty tile rounds as an empty pixel beside a triangle does.
        scratch_.color.reserve(static_cast<std::size_t>(samples_) * 4 * kTilePixels);
        fill_samples();
        resolve();
        return;
    }
    // Goes through samples in every case. Otherwise it would round differently in a tile or region that has nothing to blend.
    const Vec4f back = background_sample();
    const float sample[4] = {back.x, back.y, back.z, back.w};
    float sum[4] = {0, 0, 0, 0};
    for (int s = 0; s < samples_; ++s)
        for (int i = 0; i < 4; ++i) sum[i] += sample[i];
    const Vec4f b = resolved(sum, 1.0f / static_cast<float>(samples_));
    const Output& output = pass_.output;
    if (output.codes) {
        alignas(64) float red[16], green[16], blue[16], alpha[16];
        for (int l = 0; l < 16; ++l) {
            red[l] = b.x;
            green[l] = b.y;
            blue[l] = b.z;
            alpha[l] = b.w;
        }
        std::uint32_t code[kTileStride];
        pass_.view.shade.encode_srgb8(red, green, blue, alpha, 1.0f, code, 1);
        output.finish_codes(code, 1);
        for (int x = 1; x < written_.width; ++x) code[x] = code[0];
        for (int y = 0; y < written_.height; ++y)
            std::memcpy(output.codes.at(written_.x, written_.y + y), code, 4 * static_cast<std::size_t>(written_.width));
    }
    if (output.linear)
        for (int y = 0; y < written_.height; ++y)
            for (int x = 0; x < written_.width; ++x) output.write_linear(written_.x + x, written_.y + y, b.x, b.y, b.z, b.w);
}

void PictureTile::resolve() {
    const Output& output = pass_.output;
    const float weight = 1.0f / static_cast<float>(samples_);
    alignas(64) float row[4][kTileStride] = {};
    alignas(64) std::uint32_t code[kTileStride];
    const int x0 = written_.x - rect_.x, y0 = written_.y - rect_.y, count = written_.width;
    const auto set = [&](int x, Vec4f pixel) {
        row[0][x] = pixel.x;
        row[1][x] = pixel.y;
        row[2][x] = pixel.z;
        row[3][x] = pixel.w;
    };
    for (int y = y0; y < y0 + written_.height; ++y) {
        const int at = y * kTileStride + x0;
        if (output.linear || !toned_)
            for (int x = 0; x < count; ++x) {
                float sum[4] = {0, 0, 0, 0};
                for (int s = 0; s < samples_; ++s)
                    for (int i = 0; i < 4; ++i) sum[i] += sample_color(s)[4 * (at + x) + i];
                set(x, resolved(sum, weight));
            }
        if (output.linear)
            for (int x = 0; x < count; ++x) output.write_linear(written_.x + x, rect_.y + y, row[0][x], row[1][x], row[2][x], row[3][x]);
        if (!output.codes) continue;
        if (toned_) {
            float sums[4][kTileStride] = {};
            float* const rows[4] = {sums[0], sums[1], sums[2], sums[3]};
            add_toned_samples(at, count, rows);
            for (int x = 0; x < count; ++x) {
                const float sum[4] = {sums[0][x], sums[1][x], sums[2][x], sums[3][x]};
                set(x, resolved(sum, weight));
            }
        }
        pass_.view.shade.encode_srgb8(row[0], row[1], row[2], row[3], 1.0f, code, count);
        output.finish_codes(code, count);
        std::memcpy(output.codes.at(written_.x, rect_.y + y), code, 4 * static_cast<std::size_t>(count));
    }
}

}  // namespace halflit::raster
