#include "apps/engine/film/film_writer.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace halflit::film {

std::optional<FilmFormat> film_format_of(std::string_view path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string_view::npos || path[dot] == '/' || path.find('{') != std::string_view::npos) return std::nullopt;
    std::string extension(path.substr(dot + 1));
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == "gif") return FilmFormat::gif;
    if (extension == "apng") return FilmFormat::apng;
    if (extension == "webp") return FilmFormat::webp;
    return std::nullopt;
}

Result<void> check_film_format(std::string_view path, FilmFormat format) {
    const auto missing = [&](const char* files, const char* library) {
        return fail(ErrorCode::usage, std::string(path) + ": " + files + " files need the library " + library +
                                          ", which this build lacks (.apng needs none)");
    };
    if (format == FilmFormat::gif && !has_gif()) return missing("GIF", "giflib");
    if (format == FilmFormat::webp && !has_webp()) return missing("WebP", "libwebpmux");
    return {};
}

std::int64_t rounded_time(const FrameTime& frame_time, std::size_t i, std::int64_t units_per_s) {
    __extension__ using Wide = __int128;  // 10^7 frames of 10^9 seconds in milliseconds
    const auto start = [&](Wide frame) {
        return (2 * frame * frame_time.numerator * units_per_s + frame_time.denominator) / (2 * frame_time.denominator);
    };
    const auto frame = static_cast<std::int64_t>(i);
    return static_cast<std::int64_t>(start(frame + 1) - start(frame));
}

Result<std::unique_ptr<FilmWriter>> make_film_writer(FilmFormat format, const FilmSettings& settings) {
    constexpr int kMostGifFps = 50, kMostGif = 65535, kMostWebp = 16383;
    const int side = std::max(settings.width, settings.height);
    if (format == FilmFormat::gif && settings.frame_time.denominator > kMostGifFps * settings.frame_time.numerator)
        return fail(ErrorCode::usage, "GIF: expected at most 50 frames a second, as players show faster ones ten times slower");
    if (format == FilmFormat::gif && side > kMostGif) return fail(ErrorCode::limit, "GIF holds at most 65535 pixels a side");
    if (format == FilmFormat::webp && side > kMostWebp) return fail(ErrorCode::limit, "WebP holds at most 16383 pixels a side");
    if (const auto checked = check_film_format("", format); !checked) return tl::unexpected(checked.error());
    auto writer = format == FilmFormat::gif    ? make_gif_writer(settings)
                  : format == FilmFormat::apng ? make_apng_writer(settings)
                                               : make_webp_writer(settings);
    if (writer == nullptr) return fail(ErrorCode::limit, "out of memory while encoding the frames");
    return writer;
}

}  // namespace halflit::film
