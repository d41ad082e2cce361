// The picture that slicers write into G-code: lines of base64 in comments, "; thumbnail begin 300x300 12345" before them.
#include "apps/io/files/uri.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::io::detail {

std::optional<LoadedScene> read_gcode_picture(const ModelFile& file, const LoadOptions& options) {
    constexpr std::size_t kMostSearched = std::size_t{16} << 20;  // slicers write it before the code
    const std::string_view text = as_text(file.bytes);
    struct Picture {
        std::uint64_t pixels = 0;
        std::string name, base64;
    } best, found;
    bool is_inside = false;
    Lines lines(text.substr(0, kMostSearched));
    for (std::string_view line; lines.next(line);) {
        Words words(line);
        if (words.next() != ";") continue;
        const std::string_view first = words.next(), second = words.next(), size = words.next();
        const bool is_mark = first.starts_with("thumbnail") && !first.ends_with("QOI");
        if (is_mark && second == "begin") {
            const std::size_t x = std::min(size.find('x'), size.size());
            const std::uint64_t width = parse_whole<std::uint32_t>(size.substr(0, x)).value_or(0);
            const std::uint64_t height = parse_whole<std::uint32_t>(size.substr(std::min(size.size(), x + 1))).value_or(0);
            found = {width * height, fmt::format("{} {}", first, size), "data:;base64,"};
            is_inside = true;
        } else if (is_mark && second == "end") {
            if (is_inside && found.pixels > best.pixels) best = std::move(found);
            is_inside = false;
        } else if (is_inside) {
            found.base64 += first;
        }
    }
    if (best.pixels == 0) return std::nullopt;
    auto picture = decode_data_uri(best.base64, options.limits.max_file_bytes);
    if (!picture) return std::nullopt;
    ModelBuilder builder(file.bytes, file.folder, options, "G-code");
    if (!builder.place_card(*std::move(picture), best.name)) return std::nullopt;
    return builder.finish({.up = UpAxis::z});
}

}  // namespace halflit::io::detail
