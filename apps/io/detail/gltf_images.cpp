#include "apps/io/detail/gltf_images.hpp"

#include "apps/io/detail/uri.hpp"
#include "apps/io/image_reader.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {

namespace {

/// Memory of a texture: RGBA at 16 bits, and a third more for the smaller mip levels.
std::uint64_t texture_bytes(const ImageHeader& header) {
    return static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height) * 32 / 3;
}

/// The texture in place of a picture that cannot be read: 8x8 magenta and black.
Texture checkerboard(ColorSpace space) {
    std::vector<std::uint8_t> rgba(8 * 8 * 4, 255);
    for (std::size_t i = 0; i < 64; ++i) {
        const bool magenta = (i % 8 + i / 8) % 2 == 0;
        rgba[4 * i] = rgba[4 * i + 2] = magenta ? 255 : 0;
        rgba[4 * i + 1] = 0;
    }
    return take(Texture::from_rgba8(rgba, 8, 8, space), "magenta checkerboard");
}

std::string identity(const file::Image& entry) {
    return entry.buffer_view >= 0 ? fmt::format("bufferView {}", entry.buffer_view) : std::string(entry.uri.value_or(""));
}

}  // namespace

ImageStore::ImageStore(Document& document, std::vector<Texture>& textures)
    : document_(document), textures_(textures), texture_memory_("the textures", document.options.limits.max_texture_bytes) {}

Texture ImageStore::make(int image, ColorSpace space) {
    document_.check_time();
    const file::Image& entry = document_.file.images[static_cast<std::size_t>(image)];
    const LoadLimits& limits = document_.options.limits;
    std::string where = fmt::format("images[{}]", image);
    std::vector<std::byte> owned;
    std::span<const std::byte> bytes;
    if (entry.buffer_view >= 0 && entry.uri) refuse(where, "has both a uri and a bufferView, which exclude each other");
    if (entry.buffer_view >= 0) {
        const file::BufferView& view = document_.file.buffer_views[static_cast<std::size_t>(entry.buffer_view)];
        bytes = {document_.view_data(entry.buffer_view), static_cast<std::size_t>(view.byte_length)};
    } else if (entry.uri && is_data_uri(*entry.uri)) {
        owned = take(decode_data_uri(*entry.uri, limits.max_file_bytes), where + ".uri");
        bytes = owned;
    } else if (entry.uri) {
        owned = take(document_.folder.read(take(decode_file_uri(*entry.uri), where + ".uri"), limits.max_file_bytes), where + ".uri");
        bytes = owned;
        where += fmt::format(".uri: \"{}\"", printable(*entry.uri, 120));
    } else {
        refuse(where, "expected a uri or a bufferView, found neither");
    }
    document_.encoded_images.take(bytes.size());

    const ImageLimits image_limits{limits.max_texture_side, limits.max_texture_pixels, limits.max_jpeg_scans};
    const ImageHeader header = take(read_image_header(bytes, image_limits), where);
    const std::string_view type = header.format == ImageFormat::png ? "image/png" : "image/jpeg";
    if (!entry.mime_type.empty() && entry.mime_type != type)
        document_.warn(fmt::format("images[{}].mimeType: is \"{}\", but the picture is {}", image, printable(entry.mime_type, 40), type));
    if (texture_bytes(header) > texture_memory_.left())
        refuse(where, fmt::format("the textures would take more than {} MB, which is the limit", limits.max_texture_bytes >> 20),
               ErrorCode::limit);
    const bool keep_16_bits = header.bits == 16 && space == ColorSpace::linear;
    const DecodedImage picture = take(decode_image(bytes, image_limits, keep_16_bits), where);
    texture_memory_.take(texture_bytes(header));
    return take(keep_16_bits ? Texture::from_rgba16(picture.rgba16, picture.width, picture.height)
                             : Texture::from_rgba8(picture.rgba8, picture.width, picture.height, space),
                where);
}

int ImageStore::texture_for(int image, ColorSpace space) {
    const auto [found, is_new] =
        made_.try_emplace({identity(document_.file.images[static_cast<std::size_t>(image)]), space}, static_cast<int>(textures_.size()));
    if (!is_new) return found->second;
    try {
        textures_.push_back(make(image, space));
    } catch (const LoadFailure& failure) {
        if (!document_.options.lenient || failure.error.code != ErrorCode::bad_input) throw;
        document_.warn(failure.error.message + "; drawn as a magenta checkerboard");
        textures_.push_back(checkerboard(space));
    }
    return found->second;
}

}  // namespace halflit::io::detail
