#include "apps/io/pictures/grey_png.hpp"

#include <spng.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <string>

namespace halflit::io {

Result<std::vector<std::uint8_t>> encode_grey16(int width, int height, std::span<const std::uint16_t> values) {
    struct Free {
        void operator()(spng_ctx* context) const { spng_ctx_free(context); }
        void operator()(void* memory) const { std::free(memory); }
    };
    const std::unique_ptr<spng_ctx, Free> context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) throw std::bad_alloc();
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(width);
    header.height = static_cast<std::uint32_t>(height);
    header.bit_depth = 16;
    header.color_type = SPNG_COLOR_TYPE_GRAYSCALE;
    int error = spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    if (error == 0) error = spng_set_ihdr(context.get(), &header);
    if (error == 0) error = spng_encode_image(context.get(), values.data(), values.size_bytes(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    std::size_t size = 0;
    const std::unique_ptr<void, Free> file(error == 0 ? spng_get_png_buffer(context.get(), &size, &error) : nullptr);
    if (error == SPNG_EMEM) throw std::bad_alloc();
    if (error != 0 || !file) return fail(ErrorCode::internal, std::string("PNG: ") + spng_strerror(error));
    const auto* bytes = static_cast<const std::uint8_t*>(file.get());
    return std::vector<std::uint8_t>(bytes, bytes + size);
}

}  // namespace halflit::io
