#include "halflit/image.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/pictures/float_image.hpp"

namespace halflit {

using namespace io;

Result<EnvironmentImage> read_environment(const std::string& path, const EnvironmentLimits& limits) {
    return io::detail::errors_of(path, limits.time_limit_s, [&]() -> Result<EnvironmentImage> {
        const auto file = read_file(path, limits.max_file_bytes);
        if (!file) return tl::unexpected(file.error());
        // A small file of many pixels holds little light: its size bounds them, beyond those of an image that is large in memory.
        constexpr std::size_t kFreePixels = std::size_t{8192} * 4096, kPixelsAByte = 16;
        auto image = decode_float_image(*file, {limits.max_width, limits.max_height, kFreePixels + kPixelsAByte * file->size()});
        if (!image) return fail(image.error().code, printable(path) + ": " + image.error().message);
        return EnvironmentImage{image->width, image->height, std::move(image->rgb), false};
    });
}

}  // namespace halflit
