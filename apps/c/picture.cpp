// Functions of halflit.h about finished pictures, versions and errors.
#include "apps/c/convert.hpp"
#include "apps/c/versioned.hpp"

#include <halflit/image.hpp>
#include <halflit/version.hpp>

#include <cstring>

using namespace halflit;
using namespace halflit::c;

namespace {

/// One row of 8-bit pixels as RGBA, not premultiplied.
void copy_row(const std::uint8_t* from, std::int32_t format, std::size_t width, std::uint8_t* to) {
    for (std::size_t x = 0; x < width; ++x, from += 4, to += 4) {
        const std::uint8_t rgba[4] = {from[is_bgra(format) ? 2 : 0], from[1], from[is_bgra(format) ? 0 : 2], from[3]};
        const unsigned alpha = rgba[3];
        for (int c = 0; c < 3; ++c)
            to[c] = !is_premultiplied(format) ? rgba[c]
                    : alpha == 0              ? std::uint8_t{0}
                                              : static_cast<std::uint8_t>(std::min(255u, (rgba[c] * 255u + alpha / 2) / alpha));
        to[3] = rgba[3];
    }
}

void copy_row(const std::uint8_t* from, std::int32_t format, std::size_t width, float* to) {
    std::memcpy(to, from, 4 * width * sizeof(float));
    if (!is_premultiplied(format)) return;
    for (float* end = to + 4 * width; to != end; to += 4)
        for (int c = 0; c < 3; ++c) to[c] = to[3] > 0.0f ? to[c] / to[3] : 0.0f;
}

template <class Channel>
Result<std::vector<Channel>> copy_rows(const halflit_target& target) {
    const auto width = static_cast<std::size_t>(target.width), height = static_cast<std::size_t>(target.height);
    const std::size_t packed = 4 * width * sizeof(Channel), row_bytes = target.row_bytes != 0 ? target.row_bytes : packed;
    if (row_bytes < packed)
        return fail(ErrorCode::usage,
                    "halflit_target: row_bytes is " + std::to_string(row_bytes) + ", expected 0 or at least " + std::to_string(packed));
    std::vector<Channel> channels(4 * width * height);
    for (std::size_t y = 0; y < height; ++y)
        copy_row(static_cast<const std::uint8_t*>(target.pixels) + y * row_bytes, target.format, width, channels.data() + 4 * width * y);
    return channels;
}

/// The target's pixels as a picture for a format. name: for messages.
Result<Image> image_for(OutputFormat format, const char* name, const halflit_target* target) {
    const auto from = target_struct(target);
    if (!from) return tl::unexpected<Error>(from.error());
    if (from->pixels == nullptr) return fail(ErrorCode::usage, "halflit_target: pixels is null");
    if (from->region_alone != 0)
        return fail(ErrorCode::usage, "halflit_target: region_alone is set; a picture to write has the size of its memory");
    if (is_linear(format) != is_float(from->format))
        return fail(ErrorCode::usage, std::string(name) + ": expected a target of " +
                                          (is_linear(format) ? "floats (RGBA_F32)" : "8-bit codes (RGBA8 or BGRA8)"));
    if (from->width < 1 || from->height < 1) return fail(ErrorCode::usage, "a picture needs at least one pixel");
    if (std::int64_t{from->width} * from->height > kMaxImagePixels) return fail(ErrorCode::limit, "a picture of more than 2^28 pixels");
    Image image{from->width, from->height, {}, {}};
    if (is_float(from->format)) {
        auto rows = copy_rows<float>(*from);
        if (!rows) return tl::unexpected<Error>(rows.error());
        image.rgba_linear = std::move(*rows);
    } else {
        auto rows = copy_rows<std::uint8_t>(*from);
        if (!rows) return tl::unexpected<Error>(rows.error());
        image.rgba8 = std::move(*rows);
    }
    return image;
}

}  // namespace

const char* halflit_version(void) { return version(); }

int32_t halflit_pixel_epoch(void) { return pixel_epoch(); }

const char* halflit_last_error(void) { return last_failure(); }

uint64_t halflit_pixel_hash(const void* bytes, size_t count) {
    return pixel_hash({static_cast<const std::uint8_t*>(bytes), bytes != nullptr ? count : 0});
}

int32_t halflit_write_image(const char* path, const halflit_target* target) {
    return guarded(__func__, {{path, "path"}, {target, "target"}}, [&]() -> Result<void> {
        const auto format = output_format_of(path);
        if (!format) return tl::unexpected<Error>(format.error());
        const auto image = image_for(*format, path, target);
        if (!image) return tl::unexpected<Error>(image.error());
        return write_image(path, *image);
    });
}

int32_t halflit_encode_image(const char* format_name, const halflit_target* target, halflit_write write, void* user) {
    return guarded(__func__, {{format_name, "format"}, {target, "target"}}, [&]() -> Result<void> {
        if (write == nullptr) return fail(ErrorCode::usage, "write is null");
        const auto format = output_format_of("picture." + std::string(format_name));
        if (!format) return tl::unexpected<Error>(format.error());
        const auto image = image_for(*format, format_name, target);
        if (!image) return tl::unexpected<Error>(image.error());
        const auto bytes = encode_image(*image, *format);
        if (!bytes) return tl::unexpected<Error>(bytes.error());
        write(user, bytes->data(), bytes->size());
        return {};
    });
}
