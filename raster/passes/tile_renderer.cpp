#include "raster/passes/tile_renderer.hpp"

#include "raster/passes/count_work.hpp"
#include "raster/passes/shading_rate.hpp"

#include <cstring>

namespace halflit::raster {
namespace {

/// NaN to 0; everything else as it is.
float number_or_zero(float x) { return x == x ? x : 0.0f; }

Vec4f number_or_zero(Vec4f v) { return {number_or_zero(v.x), number_or_zero(v.y), number_or_zero(v.z), number_or_zero(v.w)}; }

/// What a pixel shows: the mean of its samples, `sum` of light times alpha and of alpha, no longer multiplied by alpha. Samples may hold
/// infinities, whose sums and quotients may be NaN.
Vec4f resolved(const float (&sum)[4], float weight) {
    const float alpha = sum[3] * weight;
    if (!(alpha > 0.0f)) return {0, 0, 0, number_or_zero(alpha)};
    return number_or_zero(Vec4f{sum[0] * weight / alpha, sum[1] * weight / alpha, sum[2] * weight / alpha, alpha});
}

}  // namespace

TileCounts TileRenderer::render() {
    direct_ = frame_.pattern.count == 1 && !frame_.has_blend;
    if (!has_triangles()) {
        fill_background();
        return counts_;
    }
    draw_visibility();
    if (direct_) {
        fill_background();
    } else {
        float* color = scratch_.color.reserve(static_cast<std::size_t>(frame_.pattern.count) * 4 * kTilePixels);
        const Vec4f b = number_or_zero(frame_.settings->background_linear);
        const float back[4] = {b.x * b.w, b.y * b.w, b.z * b.w, b.w};
        for (int i = 0; i < frame_.pattern.count * kTilePixels; ++i) std::memcpy(color + 4 * i, back, sizeof back);
        if (frame_.background) fill_samples();
    }
    shade_visible();
    if (!direct_) {
        blend_layers();
        resolve();
    }
    return counts_;
}

void TileRenderer::shade_visible() {
    FragmentQueue& queue = scratch_.queue;
    queue.begin(frame_.plan.materials.size());
    const auto flush = [&](FragmentList& list) {
        shade(list);
        if (direct_)
            write_direct(list);
        else
            write_samples(list, false);
        list.count = 0;
    };
    std::uint32_t last_id = kNoTriangle;
    FragmentList* list = nullptr;
    const auto push = [&](std::uint32_t id, int x, int y, int at, unsigned samples) {
        if (id != last_id) {
            last_id = id;
            list = &queue.of(draw_of(frame_.record(id)).material);
        }
        list->push(id, rect_.x + x, rect_.y + y, at, samples);
        if (list->full()) flush(*list);
    };
    for (int y = 0; y < rect_.height; ++y) {
        for (int x = 0; x < rect_.width; ++x) {
            const int at = y * kTileStride + x;
            if (frame_.pattern.count == 1) {
                const std::uint32_t id = buffers_.triangle[0][at];
                if (id == kNoTriangle) continue;
                ++counts_.pixels_visible;
                push(id, x, y, at, 1u);
                continue;
            }
            const unsigned all = (1u << frame_.pattern.count) - 1u;
            const std::uint32_t first = buffers_.triangle[0][at];
            std::uint32_t mixed = 0;
            for (int s = 1; s < frame_.pattern.count; ++s) mixed |= buffers_.triangle[s][at] ^ first;
            if (mixed == 0) {
                if (first == kNoTriangle) continue;
                ++counts_.pixels_visible;
                push(first, x, y, at, all);
                continue;
            }
            unsigned left = all;
            bool visible = false;
            while (left != 0) {
                const std::uint32_t id = buffers_.triangle[__builtin_ctz(left)][at];
                unsigned samples = 0;
                for (int s = 0; s < frame_.pattern.count; ++s) samples |= buffers_.triangle[s][at] == id ? 1u << s : 0u;
                left &= ~samples;
                if (id == kNoTriangle) continue;
                visible = true;
                push(id, x, y, at, samples);
            }
            counts_.pixels_visible += visible ? 1 : 0;
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        if (queue[i].count > 0) flush(queue[i]);
}

void TileRenderer::shade(FragmentList& list) {
    shading::FragmentBlock& block = scratch_.block;
    interpolate(frame_, list, block);
    const shading::MaterialPlan& plan = frame_.plan.materials[static_cast<std::size_t>(list.material)];
    shading::LightList lights;
    if ((plan.stages & shading::kStagePrelit) != 0) {
        if (frame_.settings->shading.rate == shading::ShadingRate::flat) light_triangles(frame_, list, block, counts_.work);
    } else if ((plan.stages & shading::kStageLights) != 0) {
        lights = frame_.lights.select(block, list.count, scratch_.lights);
        count_lights(counts_.work, plan, lights, list.count);
    }
    count_shading(counts_.work, plan, list.count);
    if (frame_.settings->shading.accuracy == shading::Accuracy::reference)
        frame_.reference.shade(*frame_.shade, frame_.plan, list.material, block, list.count);
    else
        frame_.shade->shade(frame_.plan, plan, lights, block, list.count);
    counts_.fragments_shaded += static_cast<std::uint64_t>(list.count);
    for (int l = 0; l < list.count; ++l) {
        const float sum = (block.red[l] + block.green[l]) + (block.blue[l] + block.alpha[l]);
        // A sum of infinities may be NaN without a NaN term; look closer only then.
        if (sum != sum && (block.red[l] != block.red[l] || block.green[l] != block.green[l] || block.blue[l] != block.blue[l] ||
                           block.alpha[l] != block.alpha[l]))
            ++counts_.nan_pixels;
    }
}

void TileRenderer::write_direct(const FragmentList& list) {
    const shading::FragmentBlock& block = scratch_.block;
    const FramebufferView& target = frame_.target;
    const float exposure = frame_.settings->exposure;
    if (target.rgba8) {
        alignas(64) std::uint32_t code[shading::kBlockSize];
        frame_.shade->encode_srgb8(block.red, block.green, block.blue, block.alpha, exposure, code, list.count);
        for (int l = 0; l < list.count; ++l)
            std::memcpy(target.rgba8 + 4 * (static_cast<std::size_t>(list.y_px[l]) * static_cast<std::size_t>(target.width) +
                                            static_cast<std::size_t>(list.x_px[l])),
                        &code[l], 4);
    }
    if (target.rgba_linear) {
        for (int l = 0; l < list.count; ++l) {
            float* p = target.rgba_linear + 4 * (static_cast<std::size_t>(list.y_px[l]) * static_cast<std::size_t>(target.width) +
                                                 static_cast<std::size_t>(list.x_px[l]));
            p[0] = number_or_zero(block.red[l] * exposure);
            p[1] = number_or_zero(block.green[l] * exposure);
            p[2] = number_or_zero(block.blue[l] * exposure);
            p[3] = number_or_zero(block.alpha[l]);
        }
    }
}

void TileRenderer::write_samples(const FragmentList& list, bool blend) {
    const shading::FragmentBlock& block = scratch_.block;
    const float exposure = frame_.settings->exposure;
    for (int l = 0; l < list.count; ++l) {
        const float a = number_or_zero(block.alpha[l]);
        const float source[4] = {number_or_zero(block.red[l] * exposure) * a, number_or_zero(block.green[l] * exposure) * a,
                                 number_or_zero(block.blue[l] * exposure) * a, a};
        for (unsigned samples = list.samples[l]; samples != 0; samples &= samples - 1) {
            float* p = sample_color(__builtin_ctz(samples)) + 4 * list.at[l];
            const float keep = blend ? 1.0f - a : 0.0f;
            for (int i = 0; i < 4; ++i) p[i] = blend ? source[i] + p[i] * keep : source[i];
        }
    }
}

void TileRenderer::fill_samples() {
    for (int y = 0; y < rect_.height; ++y)
        for (int x = 0; x < rect_.width; ++x) {
            const Vec4f b = number_or_zero(frame_.background.at(rect_.x + x, rect_.y + y));
            for (int s = 0; s < frame_.pattern.count; ++s) std::memcpy(sample_color(s) + 4 * (y * kTileStride + x), &b, sizeof b);
        }
}

void TileRenderer::fill_background() {
    if (frame_.background) {
        // By way of samples, so that an empty tile rounds as an empty pixel beside a triangle does.
        scratch_.color.reserve(static_cast<std::size_t>(frame_.pattern.count) * 4 * kTilePixels);
        fill_samples();
        resolve();
        return;
    }
    Vec4f b = number_or_zero(frame_.settings->background_linear);
    if (!direct_) {
        // A tile that nothing touches must round as an empty pixel beside a triangle does, or pixels would depend on the tile size.
        float sum[4] = {0, 0, 0, 0};
        const float back[4] = {b.x * b.w, b.y * b.w, b.z * b.w, b.w};
        for (int s = 0; s < frame_.pattern.count; ++s)
            for (int i = 0; i < 4; ++i) sum[i] += back[i];
        b = resolved(sum, 1.0f / static_cast<float>(frame_.pattern.count));
    }
    const FramebufferView& target = frame_.target;
    if (target.rgba8) {
        alignas(64) float red[16], green[16], blue[16], alpha[16];
        for (int l = 0; l < 16; ++l) {
            red[l] = b.x;
            green[l] = b.y;
            blue[l] = b.z;
            alpha[l] = b.w;
        }
        std::uint32_t code[16];
        frame_.shade->encode_srgb8(red, green, blue, alpha, 1.0f, code, 1);
        for (int y = 0; y < rect_.height; ++y)
            for (int x = 0; x < rect_.width; ++x)
                std::memcpy(target.rgba8 + 4 * (static_cast<std::size_t>(rect_.y + y) * static_cast<std::size_t>(target.width) +
                                                static_cast<std::size_t>(rect_.x + x)),
                            &code[0], 4);
    }
    if (target.rgba_linear) {
        const float back[4] = {b.x, b.y, b.z, b.w};
        for (int y = 0; y < rect_.height; ++y)
            for (int x = 0; x < rect_.width; ++x)
                std::memcpy(target.rgba_linear + 4 * (static_cast<std::size_t>(rect_.y + y) * static_cast<std::size_t>(target.width) +
                                                      static_cast<std::size_t>(rect_.x + x)),
                            back, sizeof back);
    }
}

void TileRenderer::resolve() {
    const FramebufferView& target = frame_.target;
    const float weight = 1.0f / static_cast<float>(frame_.pattern.count);
    alignas(64) float row[4][kTileStride] = {};
    alignas(64) std::uint32_t code[kTileStride];
    for (int y = 0; y < rect_.height; ++y) {
        for (int x = 0; x < rect_.width; ++x) {
            float sum[4] = {0, 0, 0, 0};
            for (int s = 0; s < frame_.pattern.count; ++s)
                for (int i = 0; i < 4; ++i) sum[i] += sample_color(s)[4 * (y * kTileStride + x) + i];
            const Vec4f pixel = resolved(sum, weight);
            row[0][x] = pixel.x;
            row[1][x] = pixel.y;
            row[2][x] = pixel.z;
            row[3][x] = pixel.w;
        }
        const std::size_t first =
            static_cast<std::size_t>(rect_.y + y) * static_cast<std::size_t>(target.width) + static_cast<std::size_t>(rect_.x);
        if (target.rgba8) {
            frame_.shade->encode_srgb8(row[0], row[1], row[2], row[3], 1.0f, code, rect_.width);
            std::memcpy(target.rgba8 + 4 * first, code, 4 * static_cast<std::size_t>(rect_.width));
        }
        if (target.rgba_linear)
            for (int x = 0; x < rect_.width; ++x)
                for (int i = 0; i < 4; ++i)
                    target.rgba_linear[4 * (first + static_cast<std::size_t>(x)) + static_cast<std::size_t>(i)] = row[i][x];
    }
}

}  // namespace halflit::raster
