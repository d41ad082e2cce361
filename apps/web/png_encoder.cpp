// Of image.hpp's writer what reading models needs: PNG in memory, by stb_image_write.
#include "halflit/image.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Weverything"
#include <stb/stb_image_write.h>
#pragma clang diagnostic pop

namespace halflit {

Result<OutputFormat> output_format_of(std::string_view path) {
    std::string ending(path.substr(std::min(path.rfind('.'), path.size())));
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (ending == ".tga") return OutputFormat::tga;
    if (ending == ".png") return OutputFormat::png;
    return fail(ErrorCode::usage, "expected .png or .tga, found " + ending);
}

Result<std::vector<std::uint8_t>> encode_image(const Image& image, OutputFormat format) {
    if (format != OutputFormat::png) return fail(ErrorCode::usage, "pictures are written as PNG alone");
    int size = 0;
    unsigned char* const bytes = stbi_write_png_to_mem(image.rgba8.data(), 4 * image.width, image.width, image.height, 4, &size);
    if (bytes == nullptr) return fail(ErrorCode::limit, "PNG: out of memory");
    std::vector<std::uint8_t> file(bytes, bytes + size);
    std::free(bytes);
    return file;
}

}  // namespace halflit
