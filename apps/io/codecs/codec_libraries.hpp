// OpenEXR and Draco, which few files need. They take a quarter of the time in which a program starts, so a program may have them in a
// module, halflit_codecs.so, that is opened when the first file needs it (HALFLIT_CODEC_MODULE). Libraries have them linked.
#pragma once

#include "apps/io/codecs/draco_mesh.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#ifndef HALFLIT_CODEC_VERSION
#define HALFLIT_CODEC_VERSION ""
#endif

namespace halflit::io {

/// One channel of a picture to write: floats, those of neighbouring pixels `step` floats apart, rows after one another, the top row first.
struct ExrChannel {
    const char* name;  ///< such as "R"
    const float* data;
    int step;
};

}  // namespace halflit::io

namespace halflit::io::detail {

/// The numbers of a file as they are, three a pixel, the top row first.
struct ExrPixels {
    std::vector<float> rgb;
    std::array<bool, 3> is_half{};
};

/// Functions of the libraries. One is null where the build lacks its library. Messages of errors are the library's.
struct CodecLibraries {
    const char* version = HALFLIT_CODEC_VERSION;  ///< of the build
    /// width, height: of the header, which is checked before. check_time: called for each row; may throw.
    Result<ExrPixels> (*decode_exr)(std::span<const std::byte> file, int width, int height, void (*check_time)()) = nullptr;
    Result<std::vector<std::uint8_t>> (*encode_exr)(int width, int height, std::span<const ExrChannel> channels) = nullptr;
    Result<std::unique_ptr<DracoMesh>> (*decode_draco)(std::span<const std::byte> stream, std::uint64_t memory) = nullptr;
};

/// Fails (io) where the module is not found, or is of another build.
[[nodiscard]] Result<const CodecLibraries*> codec_libraries();

/// @{
/// As in CodecLibraries.
Result<ExrPixels> decode_exr_pixels(std::span<const std::byte> file, int width, int height, void (*check_time)());
Result<std::vector<std::uint8_t>> encode_exr_pixels(int width, int height, std::span<const ExrChannel> channels);
Result<std::unique_ptr<DracoMesh>> decode_draco_mesh(std::span<const std::byte> stream, std::uint64_t memory);
/// @}

}  // namespace halflit::io::detail

/// The name by which the module shows its functions.
extern "C" const halflit::io::detail::CodecLibraries* halflit_codec_libraries();
