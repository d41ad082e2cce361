#include "apps/io/models/mtl_pictures.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "halflit/image.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

namespace halflit::io::detail {

namespace {

bool has_ending(const std::string& file, std::string_view ending) {
    return file.size() >= ending.size() && same_word(std::string_view(file).substr(file.size() - ending.size()), ending);
}

bool has_alpha(const Image& image) {
    for (std::size_t i = 3; i < image.rgba8.size(); i += 4)
        if (image.rgba8[i] != 255) return true;
    return false;
}

std::uint8_t brightness(const std::uint8_t* texel) {
    return static_cast<std::uint8_t>((2126u * texel[0] + 7152u * texel[1] + 722u * texel[2] + 5000u) / 10000u);
}

/// The nearest texel of a picture at the size of another one.
const std::uint8_t* texel_of(const Image& image, int x, int y, int width, int height) {
    const std::int64_t column = (2 * std::int64_t{x} + 1) * image.width / (2 * std::int64_t{width});
    const std::int64_t row = (2 * std::int64_t{y} + 1) * image.height / (2 * std::int64_t{height});
    return image.rgba8.data() + 4 * (row * image.width + column);
}

/// One texture of two pictures, of the larger size: write(texel of a, texel of b, texel of the result).
template <class Write>
Image combined(const Image& a, const Image& b, const Write& write) {
    Image out{std::max(a.width, b.width), std::max(a.height, b.height), {}, {}};
    out.rgba8.resize(std::size_t{4} * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    std::uint8_t* texel = out.rgba8.data();
    for (int y = 0; y < out.height; ++y) {
        check_time();
        for (int x = 0; x < out.width; ++x, texel += 4)
            write(texel_of(a, x, y, out.width, out.height), texel_of(b, x, y, out.width, out.height), texel);
    }
    return out;
}

}  // namespace

Result<Image> MtlPictures::decode(const std::string& file) {
    if (file.empty()) return Image{1, 1, {255, 255, 255, 255}, {}};
    const LoadLimits& limits = builder_.options().limits;
    const std::string name = ModelBuilder::file_name(file);
    const auto bytes = builder_.document().read_named(name);
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_picture(*bytes, name, {limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans});
}

Image MtlPictures::decoded(const std::string& file, const std::string& where) {
    check_time();
    auto image = decode(file);
    if (!image) refuse(where, image.error().message, image.error().code);
    return *std::move(image);
}

int MtlPictures::add(const Image& image, const std::string& where, ColorSpace space, MipRule rule) {
    const auto png = encode_image(image, OutputFormat::png);
    if (!png) refuse(where, png.error().message, png.error().code);
    builder_.document().encoded_images.take(png->size());
    const auto bytes = std::as_bytes(std::span(*png));
    return builder_.texture({bytes.begin(), bytes.end()}, where, space, rule);
}

template <class Make>
int MtlPictures::once(const Key& key, const Make& make) {
    const auto known = texture_of_.find(key);
    if (known != texture_of_.end()) return known->second;
    int made = -1;
    try {
        made = make();
    } catch (const LoadFailure& failure) {
        if (builder_.options().strict || failure.error.code != ErrorCode::bad_input) throw;
        builder_.document().warn(failure.error.message + "; drawn without the picture");
    }
    texture_of_.emplace(key, made);
    return made;
}

int MtlPictures::texture(const std::string& file, const std::string& where, ColorSpace space, MipRule rule) {
    return once({file, "", space, rule}, [&] {
        if (has_ending(file, ".tga") || has_ending(file, ".bmp")) return add(decoded(file, where), where, space, rule);
        return builder_.texture(file, where, space, rule);
    });
}

int MtlPictures::with_alpha(const std::string& color, const std::string& mask, const std::string& where) {
    return once({color, mask, ColorSpace::srgb, MipRule::alpha}, [&] {
        const Image alpha = decoded(mask, where);
        const bool own_alpha = has_alpha(alpha);
        const auto write = [&](const std::uint8_t* from, const std::uint8_t* of_mask, std::uint8_t* to) {
            std::copy_n(from, 3, to);
            to[3] = own_alpha ? of_mask[3] : brightness(of_mask);
        };
        return add(combined(decoded(color, where), alpha, write), where, ColorSpace::srgb, MipRule::alpha);
    });
}

int MtlPictures::roughness_metal(const std::string& roughness, const std::string& metal, const std::string& where) {
    return once({roughness, metal, ColorSpace::linear, MipRule::equal}, [&] {
        const auto write = [](const std::uint8_t* rough, const std::uint8_t* of_metal, std::uint8_t* to) {
            to[0] = to[3] = 255;
            to[1] = brightness(rough);
            to[2] = brightness(of_metal);
        };
        return add(combined(decoded(roughness, where), decoded(metal, where), write), where, ColorSpace::linear, MipRule::equal);
    });
}

bool MtlPictures::is_grey(const std::string& file) {
    const auto known = is_grey_.find(file);
    if (known != is_grey_.end()) return known->second;
    return is_grey_[file] = holds_no_colours(file);
}

bool MtlPictures::holds_no_colours(const std::string& file) {
    check_time();
    const auto image = decode(file);
    if (!image) return false;
    for (std::size_t i = 0; i + 3 < image->rgba8.size(); i += 4) {
        const int r = image->rgba8[i], g = image->rgba8[i + 1], b = image->rgba8[i + 2];
        if (std::abs(r - g) > 8 || std::abs(g - b) > 8) return false;  // a JPEG's colours may differ a little
    }
    return true;
}

}  // namespace halflit::io::detail
