// Pictures and environments as files. The bytes of a picture depend on its pixels and the format alone: no date, name or version is stored.
// Those of a PNG, EXR or WebP also depend on the version of libdeflate, OpenEXR or libwebp, which compresses it; its pixels do not.
#pragma once

#include "halflit/environment.hpp"
#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halflit {

/// Formats of picture files; hdr is Radiance's RGBE, pfm a Portable Float Map, exr OpenEXR.
enum class OutputFormat : std::uint8_t { png, bmp, tga, jpg, webp, hdr, pfm, exr };

/// Largest number of pixels of a picture file.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// The format by the path's extension, in any case; "-" (standard output) is PNG. Anything else is a usage error that lists the formats.
[[nodiscard]] HALFLIT_API Result<OutputFormat> output_format_of(std::string_view path);

/// The extension of a format's files, without its point: "png".
[[nodiscard]] HALFLIT_API std::string_view output_format_name(OutputFormat format);

/// True for a format that stores linear floats (Image::rgba_linear) instead of sRGB codes (Image::rgba8).
[[nodiscard]] constexpr bool is_linear(OutputFormat format) { return format >= OutputFormat::hdr; }

/// True if the library was built with OpenEXR. Without it, .exr files are refused by name.
[[nodiscard]] HALFLIT_API bool has_exr();

/// Makes the whole file in memory. PNG, BMP, TGA and WebP (lossless) keep alpha; JPG (quality 95) and HDR have none and show the picture
/// over black. A PNG or EXR of a picture that is opaque everywhere is RGB. HDR holds what RGBE can: [0, 1.7e38], with NaN as 0. PFM and EXR
/// hold the float32 values of rgba_linear times alpha, which is exact where alpha is 1; PFM has no alpha. The picture may have up to
/// kMaxImagePixels.
[[nodiscard]] HALFLIT_API Result<std::vector<std::uint8_t>> encode_image(const Image& image, OutputFormat format);

/// Encodes by the path's extension and writes the file, which is either old or new, never half written; "-" is standard output.
[[nodiscard]] HALFLIT_API Result<void> write_image(const std::string& path, const Image& image);

/// Above a limit, reading ends with ErrorCode::limit.
struct EnvironmentLimits {
    int max_width = 16384, max_height = 8192;           ///< pixels
    std::size_t max_file_bytes = std::size_t{1} << 30;  ///< bytes as stored
    double time_limit_s = 0.0;                          ///< wall clock; 0: no limit
};

/// A Radiance picture (.hdr), a Portable Float Map (.pfm) or an OpenEXR picture (.exr), whichever the first bytes tell. Any aspect is
/// accepted: the picture always covers the whole sphere. Values above 1e30 are clamped to it, and negative ones to 0. An infinite half of
/// an EXR file becomes 65504, the largest half. A NaN is an error.
[[nodiscard]] HALFLIT_API Result<EnvironmentImage> read_environment(const std::string& path, const EnvironmentLimits& limits = {});

/// A clear day, 512 x 256: blue towards the zenith, pale at the horizon, ground of albedo 0.2 and a sun of 1.5 degrees radius, 40 degrees
/// high, to the right of and behind a camera that looks along -z. A white Lambert surface that faces the sun gets about 1 from the sun, and
/// one that faces up gets about 0.4 from the sky. The same bits on every machine.
[[nodiscard]] HALFLIT_API EnvironmentImage built_in_sky();

}  // namespace halflit
