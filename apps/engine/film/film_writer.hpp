// Moving pictures as one file: GIF, APNG and WebP. Frames are encoded as they come, so one picture and the compressed frames are held.
#pragma once

#include "halflit/error.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace halflit::film {

enum class FilmFormat : std::uint8_t { gif, apng, webp };

/// The format by the extension .gif, .apng or .webp of a path, in any case; none for others, and for patterns with {}: a file of each
/// frame.
[[nodiscard]] std::optional<FilmFormat> film_format_of(std::string_view path);

/// Fails (usage), with the path and the library that is missing, where this build cannot write the format.
[[nodiscard]] Result<void> check_film_format(std::string_view path, FilmFormat format);

/// Time that each frame is shown: numerator / denominator seconds, both above 0.
struct FrameTime {
    std::int64_t numerator = 1, denominator = 24;
    friend bool operator==(const FrameTime&, const FrameTime&) = default;
};

/// Properties of a file of frames that must be known before the first one.
struct FilmSettings {
    int width = 0, height = 0;  ///< pixels, of each frame
    std::size_t frames = 0;     ///< that will be added
    FrameTime frame_time{};
    bool opaque = true;   ///< no pixel of any frame is transparent
    bool dither = false;  ///< GIF: ordered dither
};

/// The time of frame i in units of 1 / units_per_s seconds, rounded. What a frame loses by rounding, the next ones get: the first n times
/// have the sum n * frame_time, rounded.
[[nodiscard]] std::int64_t rounded_time(const FrameTime& frame_time, std::size_t i, std::int64_t units_per_s);

/// Takes frames in order, then gives the file. It plays for ever.
class FilmWriter {
public:
    FilmWriter() = default;
    virtual ~FilmWriter() = default;
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// Encodes the next frame; `frame` has the settings' size. Fails (limit) where memory ends.
    [[nodiscard]] virtual Result<void> add(const Image& frame) = 0;
    /// The file, after FilmSettings::frames frames.
    [[nodiscard]] virtual Result<std::vector<std::uint8_t>> finish() = 0;
};

/// Fails (usage) for a format that this build lacks, (limit) for a picture that the format cannot hold.
[[nodiscard]] Result<std::unique_ptr<FilmWriter>> make_film_writer(FilmFormat format, const FilmSettings& settings);

// The writers. Null: this build lacks the library.
[[nodiscard]] std::unique_ptr<FilmWriter> make_gif_writer(const FilmSettings& settings);
[[nodiscard]] std::unique_ptr<FilmWriter> make_apng_writer(const FilmSettings& settings);
[[nodiscard]] std::unique_ptr<FilmWriter> make_webp_writer(const FilmSettings& settings);
/// @{
/// True if the program was built with giflib, and with libwebp and libwebpmux.
[[nodiscard]] bool has_gif();
[[nodiscard]] bool has_webp();
/// @}

}  // namespace halflit::film
