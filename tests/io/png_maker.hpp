// PNG files written by hand, with stored (uncompressed) deflate blocks: any colour type, bit depth and interlacing. The parts can also make
// faulty files.
#pragma once

#include "tests/io/gltf_builder.hpp"

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace halflit::test {

inline std::uint32_t crc32_of(const Bytes& bytes) {
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const std::byte b : bytes) {
        crc ^= static_cast<std::uint32_t>(b);
        for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

inline void append_big(Bytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::byte>(value >> shift & 255u));
}

inline void append_chunk(Bytes& file, const char* type, const Bytes& body) {
    append_big(file, static_cast<std::uint32_t>(body.size()));
    Bytes checked = to_bytes(std::string_view(type, 4));
    checked.insert(checked.end(), body.begin(), body.end());
    file.insert(file.end(), checked.begin(), checked.end());
    append_big(file, crc32_of(checked));
}

inline Bytes zlib_stored(const Bytes& raw) {
    Bytes out = {std::byte{0x78}, std::byte{0x01}};
    std::uint32_t a = 1, b = 0;
    for (std::size_t at = 0; at < raw.size() || at == 0; at += 65535) {
        const std::size_t size = std::min<std::size_t>(65535, raw.size() - at);
        out.push_back(static_cast<std::byte>(at + size == raw.size() ? 1 : 0));
        for (const std::size_t v : {size, ~size})
            for (int shift = 0; shift < 16; shift += 8) out.push_back(static_cast<std::byte>(v >> shift & 255u));
        out.insert(out.end(), raw.begin() + static_cast<std::ptrdiff_t>(at), raw.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    for (const std::byte r : raw) {
        a = (a + static_cast<std::uint32_t>(r)) % 65521;
        b = (b + a) % 65521;
    }
    append_big(out, b << 16 | a);
    return out;
}

struct PngSpec {
    std::uint32_t width = 1, height = 1;
    int bits = 8, color_type = 6;  ///< 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
    bool interlaced = false;
    Bytes palette, transparency;  ///< PLTE and tRNS
    std::vector<int> filters{};   ///< of row y: filters[y % size]; nothing: none. Only of files that are not interlaced
    Bytes last_chunks{};          ///< between the pixels and IEND
};

/// Filters rows of `size` bytes and `step` bytes a pixel, each of which has the number of its filter in front.
inline Bytes filter_rows(const Bytes& plain, std::size_t size, std::size_t step) {
    Bytes out = plain;
    for (std::size_t at = 0; at < plain.size(); ++at) {
        const std::size_t y = at / (size + 1), i = at % (size + 1);
        if (i == 0) continue;
        const auto value = [&](bool is_there, std::size_t back) { return is_there ? static_cast<int>(plain[at - back]) : 0; };
        const int left = value(i > step, step), up = value(y > 0, size + 1), corner = value(y > 0 && i > step, size + 1 + step);
        const int to_left = std::abs(up - corner), to_up = std::abs(left - corner), to_corner = std::abs(left + up - 2 * corner);
        const int paeth = to_left <= to_up && to_left <= to_corner ? left : to_up <= to_corner ? up : corner;
        const int predicted[] = {0, left, up, (left + up) / 2, paeth};
        out[at] = static_cast<std::byte>((static_cast<int>(plain[at]) - predicted[static_cast<std::size_t>(plain[at - i]) % 5]) & 255);
    }
    return out;
}

/// `sample(x, y, channel)` gives the stored value, of spec.bits bits.
inline Bytes make_png(const PngSpec& spec, const std::function<std::uint32_t(std::uint32_t, std::uint32_t, int)>& sample) {
    const int channels = spec.color_type == 2 ? 3 : spec.color_type == 4 ? 2 : spec.color_type == 6 ? 4 : 1;
    struct Pass {
        std::uint32_t x0, y0, dx, dy;
    };
    const std::vector<Pass> passes = spec.interlaced ? std::vector<Pass>{{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                                                         {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}
                                                     : std::vector<Pass>{{0, 0, 1, 1}};
    Bytes raw;
    for (const Pass& pass : passes) {
        if (pass.x0 >= spec.width) continue;
        for (std::uint32_t y = pass.y0; y < spec.height; y += pass.dy) {
            raw.push_back(static_cast<std::byte>(spec.filters.empty() ? 0 : spec.filters[y % spec.filters.size()]));
            std::uint32_t bits = 0;
            int have = 0;
            for (std::uint32_t x = pass.x0; x < spec.width; x += pass.dx)
                for (int c = 0; c < channels; ++c) {
                    bits = bits << spec.bits | sample(x, y, c);
                    for (have += spec.bits; have >= 8; have -= 8) raw.push_back(static_cast<std::byte>(bits >> (have - 8) & 255u));
                }
            if (have > 0) raw.push_back(static_cast<std::byte>(bits << (8 - have) & 255u));
        }
    }
    if (!spec.filters.empty())
        raw = filter_rows(raw, raw.size() / spec.height - 1, static_cast<std::size_t>((channels * spec.bits + 7) / 8));
    Bytes file = to_bytes("\x89PNG\r\n\x1A\n"), header;
    append_big(header, spec.width);
    append_big(header, spec.height);
    for (const int v : {spec.bits, spec.color_type, 0, 0, spec.interlaced ? 1 : 0}) header.push_back(static_cast<std::byte>(v));
    append_chunk(file, "IHDR", header);
    if (!spec.palette.empty()) append_chunk(file, "PLTE", spec.palette);
    if (!spec.transparency.empty()) append_chunk(file, "tRNS", spec.transparency);
    append_chunk(file, "IDAT", zlib_stored(raw));
    file.insert(file.end(), spec.last_chunks.begin(), spec.last_chunks.end());
    append_chunk(file, "IEND", {});
    return file;
}

/// Picture of one colour, 8-bit RGBA.
inline Bytes plain_png(std::uint32_t width, std::uint32_t height, std::uint32_t r, std::uint32_t g, std::uint32_t b,
                       std::uint32_t a = 255) {
    return make_png({width, height, 8, 6, false, {}, {}}, [=](std::uint32_t, std::uint32_t, int c) {
        return c == 0 ? r : c == 1 ? g : c == 2 ? b : a;
    });
}

}  // namespace halflit::test
