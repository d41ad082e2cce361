// Output of shaded fragments: exposure, samples, the background, the mean of a pixel's samples, sRGB codes, the caller's pixels.
#include "raster/passes/picture_tile.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace halflit::raster {
namespace {

/// 0 for NaN, x for everything else; 0 instead of -0, as a sum of samples is.
float number_or_zero(float x) { return x == x ? x + 0.0f : 0.0f; }

Vec4f number_or_zero(Vec4f v) { return {number_or_zero(v.x), number_or_zero(v.y), number_or_zero(v.z), number_or_zero(v.w)}; }

/// Lays a black surface over light times alpha, and alpha.
Vec4f under_shadow(Vec4f back, float opacity) {
    const float kept = 1.0f - opacity;
    return number_or_zero(Vec4f{back.x * kept, back.y * kept, back.z * kept, back.w * kept + opacity});
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
    if (has_whole_) {
        TileScratch::PartPixels& parts = scratch_.parts;
        std::fill_n(parts.whole, kMaxTileSize, std::uint64_t{0});
        std::fill_n(parts.part, kMaxTileSize, std::uint64_t{0});
        parts.count = 0;
        if (toned_) scratch_.backing.reserve(static_cast<std::size_t>(samples_) * kTilePixels);
        return;
    }
    fill_backing(1.0f);
    if (background_varies()) {
        fill_samples();
        return;
    }
    const Vec4f back = background_sample();
    for (int i = 0; i < samples_ * kTilePixels; ++i) std::memcpy(color + 4 * i, &back, sizeof back);
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

int PictureTile::part_of(int at) {
    TileScratch::PartPixels& parts = scratch_.parts;
    std::uint64_t& row = parts.part[at / kTileStride];
    const std::uint64_t bit = std::uint64_t{1} << (at % kTileStride);
    if ((row & bit) != 0) return parts.place[at];
    row |= bit;
    const int place = parts.count++;
    parts.place[at] = static_cast<std::uint16_t>(place);
    parts.pixel[place] = static_cast<std::uint16_t>(at);
    set_background(at, place);
    return place;
}

/// An environment is light, as a surface's is. A shadow is a black surface before either, and a part of the background.
Vec4f PictureTile::background_at(int at) const {
    const int x = rect_.x + at % kTileStride, y = rect_.y + at / kTileStride;
    const Vec4f back = has_background() ? number_or_zero(plan_.background.at(x, y)) : background_sample();
    const float shadow = has_contact_shadow_ ? shadow_row(y - rect_.y)[x - rect_.x] : 0.0f;
    return shadow == 0.0f ? back : under_shadow(back, shadow);
}

void PictureTile::set_background(int at, int place) {
    const Vec4f back = background_at(at);
    for (int s = 0; s < samples_; ++s) std::memcpy(sample_color(s) + 4 * place, &back, sizeof back);
    if (!toned_) return;
    const float share = has_background() ? 0.0f : 1.0f;
    for (int s = 0; s < samples_; ++s) scratch_.backing.data()[s * kTilePixels + place] = share;
    if (!transmits_) return;
    for (int s = 0; s < 3 * samples_; ++s) scratch_.tint.data()[s * kTilePixels + place] = share;
}

/// All samples of a pixel have one value, whose mean is taken by the operations that the mean of samples takes.
void PictureTile::write_whole(const FragmentList& list, const shading::FragmentBlock& block) {
    const Output& output = pass_.output;
    const float exposure = exposure_of(list.material), weight = 1.0f / static_cast<float>(samples_);
    const auto all = static_cast<std::int32_t>((1u << samples_) - 1u);
    const bool all_written = written_.width == rect_.width && written_.height == rect_.height;
    alignas(64) float pixel[3][shading::kBlockSize];
    const float* const light[3] = {block.red, block.green, block.blue};
    const auto take_mean = [&](float* row) {
        alignas(64) float sum[shading::kBlockSize];
        std::memcpy(sum, row, sizeof sum);
        for (int s = 1; s < samples_; ++s)
            for (int l = 0; l < shading::kBlockSize; ++l) sum[l] += row[l];
        for (int l = 0; l < shading::kBlockSize; ++l) row[l] = number_or_zero(sum[l] * weight);
    };
    const auto set_light = [&] {
        for (int c = 0; c < 3; ++c)
            for (int l = 0; l < shading::kBlockSize; ++l) pixel[c][l] = number_or_zero(light[c][l] * exposure);
    };
    const auto for_each = [&](const auto& write) {
        for (int l = 0; l < list.count; ++l)
            if (list.samples[l] == all && (all_written || is_written(list.x_px[l], list.y_px[l]))) write(l, list.x_px[l], list.y_px[l]);
    };
    if (output.codes) {
        alignas(64) std::uint32_t code[shading::kBlockSize];
        alignas(64) float opaque[shading::kBlockSize];
        if (toned_ && !is_shown(list.material)) {
            float* const display[3] = {pixel[0], pixel[1], pixel[2]};
            tone(light, exposure, display, shading::kBlockSize);
        } else {
            set_light();
        }
        for (float* row : pixel) take_mean(row);
        std::fill_n(opaque, shading::kBlockSize, 1.0f);
        pass_.view.shade.encode_srgb8(pixel[0], pixel[1], pixel[2], opaque, 1.0f, code, list.count);
        output.finish_codes(code, list.count);
        for_each([&](int l, int x, int y) { std::memcpy(output.codes.at(x, y), &code[l], sizeof code[l]); });
    }
    if (output.linear) {
        set_light();
        for (float* row : pixel) take_mean(row);
        for_each([&](int l, int x, int y) { output.write_linear(x, y, pixel[0][l], pixel[1][l], pixel[2][l], 1.0f); });
    }
    for (int l = 0; l < list.count; ++l)
        if (list.samples[l] == all) scratch_.parts.whole[list.y_px[l] - rect_.y] |= std::uint64_t{1} << (list.x_px[l] - rect_.x);
}

void PictureTile::write_samples(const FragmentList& list, const shading::FragmentBlock& block) {
    const auto all = static_cast<std::int32_t>((1u << samples_) - 1u);
    int parts = list.count;  // fragments of a part of their pixel
    if (has_whole_) {
        parts = 0;
        for (int l = 0; l < list.count; ++l) parts += list.samples[l] == all ? 0 : 1;
        if (parts < list.count) write_whole(list, block);
        if (parts == 0) return;
    }
    const bool shown = toned_ && is_shown(list.material);
    if (shown) begin_shown();
    const float exposure = exposure_of(list.material);
    for (int l = 0; l < list.count; ++l) {
        if (has_whole_ && list.samples[l] == all) continue;
        const Vec4f light = light_of(block, l, exposure);
        int at = (list.y_px[l] - rect_.y) * kTileStride + (list.x_px[l] - rect_.x);
        if (has_whole_) at = part_of(at);
        for (auto samples = static_cast<unsigned>(list.samples[l]); samples != 0; samples &= samples - 1)
            std::memcpy(sample_color(__builtin_ctz(samples)) + 4 * at, &light, sizeof light);
        cover_backing(at, static_cast<unsigned>(list.samples[l]), 1.0f);
        if (shown) add_shown(at, static_cast<unsigned>(list.samples[l]), light);
    }
}

void PictureTile::fill_samples() {
    for (int y = 0; y < rect_.height; ++y)
        for (int x = 0; x < rect_.width; ++x) set_background(y * kTileStride + x, y * kTileStride + x);
}

void PictureTile::fill_background() {
    if (has_background()) {
        // Goes through samples, so that an empty tile rounds as an empty pixel beside a triangle does.
        scratch_.color.reserve(static_cast<std::size_t>(samples_) * 4 * kTilePixels);
        fill_backing(0.0f);
        fill_samples();
        resolve();
        return;
    }
    const Pixel back = background_pixel();
    for (int y = 0; y < written_.height; ++y) write_background(written_.y - rect_.y + y, written_pixels(), back);
}

/// Goes through samples in every case. Otherwise it would round differently in a tile or region that has nothing to blend.
PictureTile::Pixel PictureTile::background_pixel() const {
    const Vec4f back = background_sample();
    alignas(64) float rows[4][kPixelsARow];
    alignas(64) constexpr float none[kPixelsARow] = {};
    float* const to[4] = {rows[0], rows[1], rows[2], rows[3]};
    pass_.view.raster.shade_background({back.x, back.y, back.z, back.w}, none, samples_, kPixelsARow, to);
    Pixel pixel{{rows[0][0], rows[1][0], rows[2][0], rows[3][0]}, 0};
    if (!pass_.output.codes) return pixel;
    alignas(64) std::uint32_t code[kPixelsARow];  // the kernel writes whole vectors
    pass_.view.shade.encode_srgb8(rows[0], rows[1], rows[2], rows[3], 1.0f, code, 1);
    pass_.output.finish_codes(code, 1);
    pixel.code = code[0];
    return pixel;
}

const float* PictureTile::shadow_row(int row) const {
    TileScratch::ShadowRows& shadow = scratch_.shadow;
    float* const opacity = shadow.opacity[row];
    if ((shadow.known >> row & 1) == 0) plan_.contact_shadow.row(pass_.view.raster, rect_.x, rect_.y + row, rect_.width, opacity);
    shadow.known |= std::uint64_t{1} << row;
    return opacity;
}

/// The same as through samples: without surfaces all are alike.
void PictureTile::write_background(int row, std::uint64_t pixels, const Pixel& plain) {
    if (pixels == 0) return;
    const Output& output = pass_.output;
    const int y = rect_.y + row;
    alignas(64) std::uint32_t code[kTileStride];
    std::fill_n(code, rect_.width, plain.code);
    int first = rect_.width, end = 0;          // of the shadow
    alignas(64) float linear[4][kTileStride];  // where it is shaded
    if (has_contact_shadow_) {
        const float* const opacity = shadow_row(row);
        for (first = 0, end = rect_.width; first < end && !(opacity[first] > 0.0f);) ++first;
        while (end > first && !(opacity[end - 1] > 0.0f)) --end;
        first &= ~(kTilePadding - 1);
        if (first < end) {
            const Vec4f back = background_sample();
            float* const rows[4] = {linear[0] + first, linear[1] + first, linear[2] + first, linear[3] + first};
            pass_.view.raster.shade_background({back.x, back.y, back.z, back.w}, opacity + first, samples_, end - first, rows);
            if (output.codes) {
                pass_.view.shade.encode_srgb8(rows[0], rows[1], rows[2], rows[3], 1.0f, code + first, end - first);
                output.finish_codes(code + first, end - first);
                std::fill(code + end, code + rect_.width, plain.code);
            }
        }
    }
    while (pixels != 0) {
        const int x = std::countr_zero(pixels), run = std::countr_one(pixels >> x);
        pixels &= run + x == 64 ? 0 : ~std::uint64_t{0} << (x + run);
        if (output.codes) std::memcpy(output.codes.at(rect_.x + x, y), code + x, 4 * static_cast<std::size_t>(run));
        if (!output.linear) continue;
        for (int i = x; i < x + run; ++i) {
            const bool is_shaded = i >= first && i < end;
            const Vec4f pixel = is_shaded ? Vec4f{linear[0][i], linear[1][i], linear[2][i], linear[3][i]} : plain.linear;
            output.write_linear(rect_.x + i, y, pixel.x, pixel.y, pixel.z, pixel.w);
        }
    }
}

void PictureTile::resolve() {
    if (has_whole_) {
        resolve_parts();
        return;
    }
    const Output& output = pass_.output;
    ResolvedPixels row;
    for (int y = written_.y; y < written_.y + written_.height; ++y) {
        resolve((y - rect_.y) * kTileStride + (written_.x - rect_.x), written_.width, row);
        if (output.linear)
            for (int x = 0; x < written_.width; ++x)
                output.write_linear(written_.x + x, y, row.linear[0][x], row.linear[1][x], row.linear[2][x], row.linear[3][x]);
        if (output.codes) std::memcpy(output.codes.at(written_.x, y), row.code, 4 * static_cast<std::size_t>(written_.width));
    }
}

void PictureTile::resolve_parts() {
    TileScratch::PartPixels& parts = scratch_.parts;
    const Output& output = pass_.output;
    // The background between them: an environment is seen through samples, as it is beside triangles.
    const Pixel back = has_background() ? Pixel{} : background_pixel();
    for (int y = written_.y; y < written_.y + written_.height; ++y) {
        const std::size_t row = static_cast<std::size_t>(y - rect_.y);
        const std::uint64_t empty = written_pixels() & ~(parts.whole[row] | parts.part[row]);
        if (!has_background()) {
            write_background(static_cast<int>(row), empty, back);
            continue;
        }
        for (std::uint64_t left = empty; left != 0; left &= left - 1)
            (void)part_of(static_cast<int>(row) * kTileStride + std::countr_zero(left));
    }
    ResolvedPixels some;
    for (int first = 0; first < parts.count; first += kMaxTileSize) {
        const int count = std::min(kMaxTileSize, parts.count - first);
        resolve(first, count, some);
        for (int i = 0; i < count; ++i) {
            const int x = rect_.x + parts.pixel[first + i] % kTileStride, y = rect_.y + parts.pixel[first + i] / kTileStride;
            if (!is_written(x, y)) continue;
            if (output.codes) std::memcpy(output.codes.at(x, y), &some.code[i], sizeof some.code[i]);
            if (output.linear) output.write_linear(x, y, some.linear[0][i], some.linear[1][i], some.linear[2][i], some.linear[3][i]);
        }
    }
}

void PictureTile::resolve(int at, int count, ResolvedPixels& out) {
    const Output& output = pass_.output;
    const auto take_means = [&](float(&of)[4][kTileStride]) {
        float* const rows[4] = {of[0], of[1], of[2], of[3]};
        pass_.view.raster.take_means(1.0f / static_cast<float>(samples_), count, rows);
    };
    if (output.linear || !toned_) {
        for (int x = 0; x < count; ++x)
            for (int i = 0; i < 4; ++i) {
                float sum = 0.0f;
                for (int s = 0; s < samples_; ++s) sum += sample_color(s)[4 * (at + x) + i];
                out.linear[i][x] = sum;
            }
        take_means(out.linear);
    }
    if (!output.codes) return;
    if (toned_) {
        for (auto& row : out.display) std::fill_n(row, kTileStride, 0.0f);
        float* const rows[4] = {out.display[0], out.display[1], out.display[2], out.display[3]};
        add_toned_samples(at, count, rows);
        take_means(out.display);
    }
    const auto& shown = toned_ ? out.display : out.linear;
    pass_.view.shade.encode_srgb8(shown[0], shown[1], shown[2], shown[3], 1.0f, out.code, count);
    output.finish_codes(out.code, count);
}

}  // namespace halflit::raster
