// The tone curve, between linear light and codes. It is applied to the light of each sample, and the mean is taken of what a display would
// show: a highlight of fifty times white then covers as much of an edge as its samples do. The background colour is a colour of the
// display already, and so is that of a material without light. Both are kept apart from the light beside them, which is mapped as it is
// without alpha and laid over them again.
#include "shading/reference/tone.hpp"
#include "raster/passes/picture_tile.hpp"

#include <algorithm>
#include <bit>

namespace halflit::raster {
namespace {

/// Pixels that are toned together where not all is opaque.
constexpr int kTonedLanes = 16;

}  // namespace

void PictureTile::tone(const float* const light[3], float exposure, float* const display[3], int count) const {
    if (pass_.reference == nullptr) {
        pass_.view.shade.tone(plan_.tone_curve, light, exposure, display, count);
        return;
    }
    for (int i = 0; i < count; ++i) {
        const auto channel = [&](int c) { return static_cast<double>(light[c][i] * exposure); };
        const Vec3d out = shading::reference::toned(plan_.tone_curve, {channel(0), channel(1), channel(2)});
        display[0][i] = static_cast<float>(out.x);
        display[1][i] = static_cast<float>(out.y);
        display[2][i] = static_cast<float>(out.z);
    }
}

void PictureTile::fill_backing(float share) {
    if (!toned_) return;
    const std::size_t count = static_cast<std::size_t>(samples_) * kTilePixels;
    std::fill_n(scratch_.backing.reserve(count), count, share);
    if (transmits_) std::fill_n(scratch_.tint.reserve(3 * count), 3 * count, share);
}

void PictureTile::begin_shown() {
    if (has_shown_) return;
    has_shown_ = true;
    const std::size_t count = static_cast<std::size_t>(samples_) * 4 * kTilePixels;
    std::fill_n(scratch_.shown.reserve(count), count, 0.0f);
}

void PictureTile::add_shown(int at, unsigned samples, Vec4f color) {
    for (; samples != 0; samples &= samples - 1) {
        float* const to = scratch_.shown.data() + 4 * (std::countr_zero(samples) * kTilePixels + at);
        to[0] += color.x;
        to[1] += color.y;
        to[2] += color.z;
        to[3] += color.w;
    }
}

void PictureTile::cover_backing(int at, unsigned samples, float alpha) {
    if (!toned_) return;
    if (transmits_) {
        const float keep = 1.0f - alpha;
        return cover_backing(at, samples, alpha, {keep, keep, keep, alpha});
    }
    float* const of_pixel = scratch_.backing.data() + at;
    if (has_shown_)
        for (unsigned left = samples; left != 0; left &= left - 1) {
            float* const shown = scratch_.shown.data() + 4 * (std::countr_zero(left) * kTilePixels + at);
            for (int i = 0; i < 4; ++i) shown[i] *= 1.0f - alpha;
        }
    for (; samples != 0; samples &= samples - 1) of_pixel[__builtin_ctz(samples) * kTilePixels] *= 1.0f - alpha;
}

void PictureTile::cover_backing(int at, unsigned samples, float alpha, Vec4f keep) {
    if (!toned_) return;
    for (; samples != 0; samples &= samples - 1) {
        const int sample = __builtin_ctz(samples);
        scratch_.backing.data()[sample * kTilePixels + at] *= 1.0f - alpha;
        float* const tint = scratch_.tint.data() + (3 * sample) * kTilePixels + at;
        tint[0] *= keep.x;
        tint[kTilePixels] *= keep.y;
        tint[2 * kTilePixels] *= keep.z;
        if (!has_shown_) continue;
        float* const shown = scratch_.shown.data() + 4 * (sample * kTilePixels + at);
        shown[0] *= keep.x;
        shown[1] *= keep.y;
        shown[2] *= keep.z;
        shown[3] *= 1.0f - alpha;
    }
}

/// Opaque and empty samples by a kernel; a vector of pixels among which there is anything else, one sample after the other.
void PictureTile::add_toned_samples(int at, int count, float* const sums[4]) {
    const bool by_kernel = !transmits_ && !has_shown_ && pass_.reference == nullptr;
    const Vec4f back = background_sample();
    for (int x = 0; x < count;) {
        float* const rest[4] = {sums[0] + x, sums[1] + x, sums[2] + x, sums[3] + x};
        int done = 0;
        if (by_kernel) {
            const shading::SampleRows rows{
                sample_color(0) + 4 * (at + x),  4 * kTilePixels, scratch_.backing.data() + at + x, kTilePixels, samples_,
                {back.x, back.y, back.z, back.w}};
            done = pass_.view.shade.tone_samples(plan_.tone_curve, rows, count - x, rest);
        }
        if (done == 0) {
            done = std::min(kTonedLanes, count - x);
            Vec4f backs[kTonedLanes];
            for (int i = 0; i < done; ++i) {
                const int place = at + x + i;
                backs[i] = has_contact_shadow_ ? background_at(has_whole_ ? scratch_.parts.pixel[place] : place) : back;
            }
            for (int s = 0; s < samples_; ++s) add_toned_sample(s, at + x, done, backs, rest);
        }
        x += done;
    }
}

void PictureTile::add_toned_sample(int s, int at, int count, const Vec4f* backs, float* const sums[4]) {
    alignas(64) float light[3][kTonedLanes] = {}, front[kTonedLanes];
    const float* const color = sample_color(s) + 4 * at;
    const float* const backing = scratch_.backing.data() + s * kTilePixels + at;
    // Share of the background colour that shows in each channel.
    const float* share_of[3] = {backing, backing, backing};
    if (transmits_)
        for (int i = 0; i < 3; ++i) share_of[i] = scratch_.tint.data() + (3 * s + i) * kTilePixels + at;
    bool plain = true;  // surfaces alone, and all of them opaque
    for (int x = 0; x < count; ++x) plain &= backing[x] == 0.0f && color[4 * x + 3] == 1.0f;
    if (transmits_)
        for (int x = 0; x < count; ++x) plain &= share_of[0][x] == 0.0f && share_of[1][x] == 0.0f && share_of[2][x] == 0.0f;
    const float* const shown = has_shown_ ? scratch_.shown.data() + 4 * (s * kTilePixels + at) : nullptr;
    // Glass leaves a colour of the display, but not its alpha.
    const auto shows = [](const float* color_and_alpha) {
        return color_and_alpha[0] != 0.0f || color_and_alpha[1] != 0.0f || color_and_alpha[2] != 0.0f || color_and_alpha[3] != 0.0f;
    };
    if (shown != nullptr)
        for (int x = 0; x < count; ++x) plain &= !shows(shown + 4 * x);
    if (plain) {
        for (int x = 0; x < count; ++x)
            for (int i = 0; i < 3; ++i) light[i][x] = color[4 * x + i];
    } else {
        for (int x = 0; x < count; ++x) {
            const float of_back[4] = {backs[x].x, backs[x].y, backs[x].z, backs[x].w};
            // The background colour is taken off. The rest is light times alpha, and alpha.
            float left[4];
            for (int i = 0; i < 4; ++i) {
                const float share = i < 3 ? share_of[i][x] : backing[x];
                left[i] = share > 0.0f ? color[4 * x + i] - of_back[i] * share : color[4 * x + i];
            }
            // Where light passes through, alpha is not the share of the surfaces, by which their light is multiplied.
            if (transmits_) left[3] = 1.0f - backing[x];
            if (shown != nullptr && shows(shown + 4 * x)) {
                for (int i = 0; i < 4; ++i) left[i] -= shown[4 * x + i];
                // A rest that rounding leaves would count as a very bright surface.
                if (left[3] < 1e-4f) left[0] = left[1] = left[2] = left[3] = 0.0f;
            }
            front[x] = left[3] > 0.0f ? left[3] : 0.0f;
            for (int i = 0; i < 3; ++i) light[i][x] = front[x] > 0.0f ? left[i] / front[x] : 0.0f;
        }
    }
    float* const rows[3] = {light[0], light[1], light[2]};
    tone(rows, 1.0f, rows, count);
    if (plain) {
        for (int x = 0; x < count; ++x) {
            for (int i = 0; i < 3; ++i) sums[i][x] += light[i][x];
            sums[3][x] += 1.0f;
        }
        return;
    }
    for (int x = 0; x < count; ++x) {
        // An infinite background must not make a NaN where it is hidden.
        const Vec4f& back = backs[x];
        const float red = share_of[0][x], green = share_of[1][x], blue = share_of[2][x];
        sums[0][x] += light[0][x] * front[x] + (red > 0.0f ? back.x * red : 0.0f);
        sums[1][x] += light[1][x] * front[x] + (green > 0.0f ? back.y * green : 0.0f);
        sums[2][x] += light[2][x] * front[x] + (blue > 0.0f ? back.z * blue : 0.0f);
        sums[3][x] += color[4 * x + 3];
        if (shown != nullptr)
            for (int i = 0; i < 3; ++i) sums[i][x] += shown[4 * x + i];
    }
}

}  // namespace halflit::raster
