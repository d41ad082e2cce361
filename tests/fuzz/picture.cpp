// Bytes as a picture of a texture: PNG, JPEG, WebP, TIFF or KTX2, at 8 bits and at 16.
#include "tests/fuzz/loading.hpp"
#include "tests/fuzz/mutate.hpp"

#include "apps/io/pictures/image_reader.hpp"
#include "halflit/texture.hpp"

namespace halflit::fuzz {
namespace {

constexpr io::ImageLimits kLimits{512, std::size_t{1} << 16, 8};

void check_decoded(const io::DecodedImage& image, const io::ImageHeader& header, bool keep_16_bits) {
    const std::size_t values = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4;
    HALFLIT_PROMISE(image.width == header.width && image.height == header.height);
    HALFLIT_PROMISE(image.width >= 1 && image.width <= kLimits.max_side && image.height >= 1 && image.height <= kLimits.max_side);
    const bool deep = keep_16_bits && header.bits == 16;
    HALFLIT_PROMISE(image.rgba8.size() == (deep ? 0 : values) && image.rgba16.size() == (deep ? values : 0));
    const auto texture = deep ? Texture::from_rgba16(image.rgba16, image.width, image.height)
                              : Texture::from_rgba8(image.rgba8, image.width, image.height, ColorSpace::srgb);
    HALFLIT_PROMISE(texture.has_value());
}

void run(View input) {
    const auto header = io::read_image_header(as_bytes(input), kLimits);
    if (!header) check_error(header.error());
    for (const bool keep_16_bits : {false, true}) {
        const auto image = io::decode_image(as_bytes(input), kLimits, keep_16_bits);
        if (!image) {
            check_error(image.error());
            continue;
        }
        HALFLIT_PROMISE(header.has_value());
        check_decoded(*image, *header, keep_16_bits);
    }
}

}  // namespace

const FuzzTarget kPicture{"picture", 16384, run, mutate_picture}, kKtx2{"ktx2", 4096, run};

}  // namespace halflit::fuzz
