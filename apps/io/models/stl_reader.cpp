// STL: triangles alone, as text or binary. Two ways to put colours into the attribute of a binary triangle are read.
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/place_table.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes: a title and the number of triangles, then one record for each

// ---- text --------------------------------------------------------------------------------------------------------------

class StlText {
public:
    StlText(std::string_view text, ModelBuilder& builder) : lines_(text), words_(""), builder_(builder) {}

    Soup read() {
        bool open = false;  // between solid and endsolid
        for (std::string_view word = next(); !word.empty(); word = next()) {
            if (same_word(word, "solid") || same_word(word, "endsolid")) {
                open = lower(word[0]) == 's';
                words_ = Words("");  // the rest of the line is a name
            } else if (same_word(word, "facet")) {
                const std::size_t before = soup_.position_of.size();
                try {
                    facet();
                } catch (const LoadFailure& failure) {
                    if (builder_.options().strict || failure.error.code != ErrorCode::bad_input || !next().empty() || before == 0) throw;
                    builder_.document().warn("it was cut off: its last triangle is left out");
                    return std::move(soup_);
                }
            } else {
                refuse_word(word, "facet or endsolid");
            }
        }
        if (open) builder_.document().warn("ends without \"endsolid\": triangles may be missing");
        return std::move(soup_);
    }

private:
    /// The next word of the text; empty at its end.
    std::string_view next() {
        for (;;) {
            if (const std::string_view word = words_.next(); !word.empty()) return word;
            std::string_view line;
            if (!lines_.next(line)) return {};
            if (lines_.number() % 65536 == 0) check_time();
            words_ = Words(line);
        }
    }
    [[noreturn]] void refuse_word(std::string_view found, std::string_view expected) const {
        refuse(fmt::format("line {}", lines_.number()), found.empty()
                                                            ? fmt::format("expected {}, the file ends: it was cut off", expected)
                                                            : fmt::format("expected {}, found \"{}\"", expected, printable(found, 40)));
    }
    void expect(const char* small) {
        const std::string_view word = next();
        if (!same_word(word, small)) refuse_word(word, small);
    }
    double number() {
        const std::string_view word = next();
        const auto value = builder_.options().strict ? parse_real<double>(word) : parse_loosely(word);
        if (!value) refuse_word(word, "a number");
        return *value;
    }
    Vec3d point() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }
    /// After "facet". The normal is not used: it follows from the corners, and writers leave it out or get it wrong.
    void facet() {
        expect("normal");
        point();
        expect("outer");
        expect("loop");
        std::string_view word = next();
        std::uint32_t place[3]{}, corners = 0;
        for (; same_word(word, "vertex"); word = next(), ++corners) {
            builder_.take_entries<Vec3d>(1);
            const std::uint32_t found = places_.add(point(), soup_.positions);
            if (corners < 3) place[corners] = found;
        }
        if (!same_word(word, "endloop")) refuse_word(word, "vertex or endloop");
        expect("endfacet");
        if (corners != 3) refuse(fmt::format("line {}", lines_.number()), fmt::format("a facet has {} corners, expected 3", corners));
        builder_.take_triangles(1);
        soup_.position_of.insert(soup_.position_of.end(), {place[0], place[1], place[2]});
    }

    Lines lines_;
    Words words_;
    ModelBuilder& builder_;
    Soup soup_;
    PlaceTable<Vec3d> places_;
};

// ---- binary ------------------------------------------------------------------------------------------------------------

/// Colours of 5 bits a channel, by Materialise Magics if the title has "COLOR=" and four bytes, else by VisCAM and SolidView.
class StlColors {
public:
    explicit StlColors(std::string_view title) {
        const std::size_t at = title.find("COLOR=");
        is_magics_ = at != std::string_view::npos && at + 10 <= title.size();
        for (std::size_t c = 0; is_magics_ && c < 4; ++c) whole_[c] = static_cast<std::uint8_t>(title[at + 6 + c]);
        for (std::size_t i = 0; i < 32; ++i) linear_[i] = linear_color(static_cast<double>(i) / 31.0);
    }
    [[nodiscard]] bool is_magics() const { return is_magics_; }
    /// Number of a triangle's colour, 0 to 0x7fff; kNone: has none of its own. Bit 15: VisCAM sets it where there is a colour, Magics where
    /// there is none.
    [[nodiscard]] std::uint32_t number_of(std::uint16_t attribute) const {
        return ((attribute & 0x8000u) != 0) == is_magics_ ? kNone : attribute & 0x7fffu;
    }
    [[nodiscard]] Vec4f color(std::uint32_t number) const {
        const float low = linear_[number & 31u], middle = linear_[number >> 5 & 31u], high = linear_[number >> 10 & 31u];
        return is_magics_ ? Vec4f{low, middle, high, 1} : Vec4f{high, middle, low, 1};  // red is low, or high
    }
    /// Colour of triangles without one of their own.
    [[nodiscard]] Vec4f whole() const {
        return {linear_color(whole_[0] / 255.0), linear_color(whole_[1] / 255.0), linear_color(whole_[2] / 255.0), 1};
    }

private:
    bool is_magics_ = false;
    std::uint8_t whole_[4] = {188, 188, 188, 255};
    float linear_[32];
};

Soup read_binary(std::span<const std::byte> bytes, ModelBuilder& builder, bool& has_colors) {
    if (bytes.size() < kHeader)
        refuse("", fmt::format("a binary STL file has at least {} bytes, found {}: it was cut off", kHeader, bytes.size()));
    const std::uint64_t given = u32_at(bytes, 80), held = (bytes.size() - kHeader) / kRecord;
    std::uint64_t count = given;
    if (bytes.size() < kHeader + kRecord * given) {
        if (builder.options().strict)
            refuse("", fmt::format("{} triangles take {} bytes, found {}: it was cut off", given, kHeader + kRecord * given, bytes.size()));
        builder.document().warn(fmt::format("it was cut off: {} triangles of {} are there", held, given));
        count = held;
    } else if (given == 0 && held > 0 && bytes.size() == kHeader + kRecord * held && !builder.options().strict) {
        builder.document().warn(fmt::format("it says that it has no triangles, but holds {}", held));
        count = held;
    }
    if (bytes.size() > kHeader + kRecord * count && count == given)
        builder.document().warn(fmt::format("{} bytes after the last triangle are ignored", bytes.size() - kHeader - kRecord * count));
    builder.take_triangles(count);
    builder.take_entries<Vec3d>(3 * count);
    const StlColors colors(as_text(bytes.first(80)));
    const auto attribute_of = [&](std::size_t t) {
        const std::size_t at = kHeader + kRecord * t + 48;
        return static_cast<std::uint16_t>(u16_at(bytes, at));
    };
    has_colors = colors.is_magics();
    for (std::size_t t = 0; t < count && !has_colors; ++t) has_colors = colors.number_of(attribute_of(t)) != kNone;

    Soup soup;
    PlaceTable<Vec3d> places;
    const auto closed_mesh_places = static_cast<std::size_t>(count / 2 + 2);
    soup.positions.reserve(closed_mesh_places);
    places.reserve(closed_mesh_places, soup.positions);
    soup.distinct = true;
    soup.position_of.reserve(static_cast<std::size_t>(3 * count));
    std::vector<std::uint32_t> index_of;  // of a colour by its number
    constexpr std::uint32_t kWhole = 0x8000;
    if (has_colors) index_of.assign(kWhole + 1, kNone);
    const auto corner = [&](std::size_t t, std::size_t c) {
        const std::size_t at = kHeader + kRecord * t + 12 + 12 * c;
        const auto coordinate = [&](std::size_t k) -> double { return std::bit_cast<float>(u32_at(bytes, at + 4 * k)); };
        return Vec3d{coordinate(0), coordinate(1), coordinate(2)};
    };
    constexpr std::size_t kAhead = 8;  // triangles
    for (std::size_t t = 0; t < count; ++t) {
        if (t % 65536 == 0) check_time();
        if (t + kAhead < count)
            for (std::size_t c = 0; c < 3; ++c) places.prefetch(corner(t + kAhead, c));
        for (std::size_t c = 0; c < 3; ++c) soup.position_of.push_back(places.add(corner(t, c), soup.positions));
        if (!has_colors) continue;
        const std::uint32_t number = std::min(colors.number_of(attribute_of(t)), kWhole);
        if (index_of[number] == kNone) {
            index_of[number] = static_cast<std::uint32_t>(soup.colors.size());
            soup.colors.push_back(number == kWhole ? colors.whole() : colors.color(number));
        }
        soup.color_of.insert(soup.color_of.end(), 3, index_of[number]);
    }
    return soup;
}

}  // namespace

bool fits_binary_stl(std::span<const std::byte> bytes) {
    return bytes.size() >= kHeader && bytes.size() == kHeader + std::uint64_t{kRecord} * u32_at(bytes, 80);
}

bool is_binary_stl(std::span<const std::byte> bytes) {
    if (fits_binary_stl(bytes)) return true;
    std::string_view text = as_text(bytes.first(std::min<std::size_t>(bytes.size(), 1024)));
    while (!text.empty() && (is_blank(text.front()) || is_line_end(text.front()))) text.remove_prefix(1);
    if (text.size() < 5 || !same_word(text.substr(0, 5), "solid")) return true;
    // Text has no zero byte and a "facet" or "endsolid" soon; a cut-off binary file that begins with "solid" has the first.
    return text.find('\0') != std::string_view::npos;
}

LoadedScene read_stl(std::span<const std::byte> bytes, const std::string& /*base_dir*/, const LoadOptions& options) {
    ModelBuilder builder(bytes, "", options, "STL");
    bool has_colors = false;
    Soup soup = is_binary_stl(bytes) ? read_binary(bytes, builder, has_colors) : StlText(as_text(bytes), builder).read();
    const int material = has_colors ? builder.colored_material() : builder.grey_material();
    builder.place_alone(std::move(soup), {&material, 1});
    return builder.finish({.up = UpAxis::z});
}

}  // namespace halflit::io::detail
