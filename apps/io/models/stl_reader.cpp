// STL: triangles alone, as text or binary. Two ways to put colours into the attribute of a binary triangle are read.
#include "apps/io/files/file_access.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/polygon.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "apps/io/models/writer_habits.hpp"
#include "sh/place_table.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kTitle = 80, kHeader = 84, kRecord = 50;  // bytes: of a title, with the number of triangles, of each triangle

// ---- text --------------------------------------------------------------------------------------------------------------

/// Reads words wherever lines end: corners count, and the ends of facets. Normals are not used: they follow from the corners, and writers
/// leave them out or get them wrong.
class StlText {
public:
    StlText(std::string_view text, ModelBuilder& builder) : scanner_(text, builder.document()), builder_(builder) {}

    Soup read() {
        scanner_.expect_next("endsolid");
        try {
            for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) read_word(word);
            if (builder_.options().strict && last_ >= Keyword::facet && last_ < Keyword::endfacet)
                scanner_.refuse_word("", kAfter[index(last_)]);
        } catch (const CutOff&) {
            corners_.clear();
            builder_.document().go_on_without({{ErrorCode::bad_input, "it was cut off"}}, "its last triangle is left out");
        }
        end_facet();
        if (last_ != Keyword::endsolid && last_ != Keyword::none)
            builder_.document().warn("ends without \"endsolid\": triangles may be missing");
        scanner_.warn();
        if (soup_.color_of.size() < soup_.position_of.size() && !soup_.color_of.empty())
            soup_.color_of.resize(soup_.position_of.size(), kNone);
        return std::move(soup_);
    }

private:
    enum class Keyword : std::uint8_t { none, solid, facet, outer, vertex, endloop, endfacet, endsolid, count };
    static constexpr std::size_t index(Keyword keyword) { return static_cast<std::size_t>(keyword); }
    /// Words that may come next, for the strict rules.
    static constexpr const char* kAfter[] = {"solid",    "facet or endsolid", "outer loop", "vertex", "vertex or endloop",
                                             "endfacet", "facet or endsolid", "solid"};

    void read_word(std::string_view word) {
        switch (lower(word[0])) {
            case 'v':
                if (same_word(word, "vertex")) return read_vertex();
                break;
            case 'f':
                if (same_word(word, "facet")) return read_facet();
                break;
            case 'e':
                if (same_word(word, "endloop")) return end_part(Keyword::endloop);
                if (same_word(word, "endfacet")) return end_part(Keyword::endfacet);
                if (same_word(word, "endsolid")) return read_name(Keyword::endsolid);
                if (same_word(word, "end")) return read_end(word);
                break;
            case 'o':
                if (same_word(word, "outer")) return begin_part(word, Keyword::outer);
                break;
            case 'l':
                if (same_word(word, "loop")) return;
                break;
            case 's':
                if (same_word(word, "solid")) return read_name(Keyword::solid);
                break;
            case 'n':
                if (same_word(word, "normal") && last_ == Keyword::facet && !builder_.options().strict) return;
                break;
            case 'c':
                if (same_word(word, "color")) return read_color(word);
                break;
            default:
                if (parse_loosely(word) && !builder_.options().strict) return;  // of a normal
        }
        scanner_.unknown(word, kAfter[index(last_)]);
    }
    void begin_part(std::string_view word, Keyword keyword) {
        static constexpr Keyword kBefore[][2] = {{Keyword::none, Keyword::none},       {Keyword::none, Keyword::endsolid},
                                                 {Keyword::solid, Keyword::endfacet},  {Keyword::facet, Keyword::facet},
                                                 {Keyword::outer, Keyword::vertex},    {Keyword::vertex, Keyword::vertex},
                                                 {Keyword::endloop, Keyword::endloop}, {Keyword::solid, Keyword::endfacet}};
        const auto& before = kBefore[index(keyword)];
        if (builder_.options().strict && last_ != before[0] && last_ != before[1]) scanner_.refuse_word(word, kAfter[index(last_)]);
        last_ = keyword;
    }
    void end_part(Keyword keyword) {
        begin_part(keyword == Keyword::endloop ? "endloop" : "endfacet", keyword);
        end_facet();
    }
    /// "end loop", "end facet", "end solid".
    void read_end(std::string_view word) {
        if (builder_.options().strict) scanner_.refuse_word(word, kAfter[index(last_)]);
        end_facet();
        const std::string_view what = scanner_.word_in_line();
        if (same_word(what, "solid")) read_name(Keyword::endsolid);
    }
    /// A name up to the end of the line, in which the first facet may stand: with a normal and a corner, which no name has.
    void read_name(Keyword keyword) {
        begin_part(keyword == Keyword::solid ? "solid" : "endsolid", keyword);
        end_facet();
        color_ = kNone;
        if (builder_.options().strict) return scanner_.skip_line();
        constexpr std::size_t kLeastOfFacet = 9;
        for (std::string_view word = scanner_.word_in_line(); !word.empty(); word = scanner_.word_in_line())
            if (same_word(word, "facet") && scanner_.words_in_line(kLeastOfFacet) == kLeastOfFacet) return read_facet();
    }
    void read_facet() {
        begin_part("facet", Keyword::facet);
        end_facet();
        if (!builder_.options().strict) return pass_normal();
        if (const std::string_view word = scanner_.word(); !same_word(word, "normal")) scanner_.refuse_word(word, "normal");
        for (int i = 0; i < 3; ++i) scanner_.number();
    }
    /// The words between "facet" and the next keyword, on the same line.
    void pass_normal() {
        for (int i = 0; i < 4; ++i) {
            const std::string_view word = scanner_.next_in_line();
            if (word.empty() || same_word(word, "outer") || same_word(word, "vertex") || same_word(word, "loop")) return;
            scanner_.word_in_line();
        }
    }
    void read_vertex() {
        begin_part("vertex", Keyword::vertex);
        builder_.take_entries<Vec3d>(1);
        const double x = scanner_.number(), y = scanner_.number(), z = scanner_.number();
        corners_.push_back({x, y, z});
    }
    /// Colour of the facets that follow, in shares or codes of sRGB.
    void read_color(std::string_view word) {
        if (builder_.options().strict) scanner_.refuse_word(word, kAfter[index(last_)]);
        double value[3] = {0, 0, 0};
        for (double& channel : value)
            if (!scanner_.take_number(channel)) return;
        const double most = std::max({value[0], value[1], value[2]}) > 1.0 ? 255.0 : 1.0;
        builder_.take_entries<Vec4f>(1);
        const Vec4f color{linear_color(value[0] / most), linear_color(value[1] / most), linear_color(value[2] / most), 1};
        if (color_ != kNone && soup_.colors[color_] == color) return;
        color_ = static_cast<std::uint32_t>(soup_.colors.size());
        soup_.colors.push_back(color);
    }
    void end_facet() {
        if (corners_.empty()) return;
        if (builder_.options().strict && corners_.size() != 3)
            refuse(scanner_.where(), fmt::format("a facet has {} corners, expected 3", corners_.size()));
        if (corners_.size() >= 3) {
            triangles_.clear();
            builder_.take_triangles(corners_.size() - 2);
            cutter_.cut(corners_, triangles_);
            for (const std::uint32_t i : triangles_) soup_.position_of.push_back(places_.add(corners_[i], soup_.positions));
            if (color_ != kNone) {
                soup_.color_of.resize(soup_.position_of.size() - triangles_.size(), kNone);
                soup_.color_of.resize(soup_.position_of.size(), color_);
            }
        }
        corners_.clear();
    }

    TextScanner scanner_;
    ModelBuilder& builder_;
    Soup soup_;
    PlaceTable<Vec3d> places_;
    PolygonCutter cutter_;
    std::vector<Vec3d> corners_;  ///< of the facet that is read
    std::vector<std::uint32_t> triangles_;
    std::uint32_t color_ = kNone;
    Keyword last_ = Keyword::none;
};

// ---- binary ------------------------------------------------------------------------------------------------------------

/// Colours of 5 bits a channel, by Materialise Magics if the title has "COLOR=" and four bytes, else by VisCAM and SolidView.
class StlColors {
public:
    /// common: the attribute of all triangles; kNone: they differ.
    StlColors(std::string_view title, std::uint32_t common) {
        const std::size_t at = title.find("COLOR=");
        is_magics_ = at != std::string_view::npos && at + 10 <= title.size();
        for (std::size_t i = 0; i < 32; ++i) linear_[i] = linear_color(static_cast<double>(i) / 31.0);
        has_none_ = means_no_color(ModelFormat::stl, [&](std::uint32_t value) { return value == common; });
        const auto channel = [&](std::size_t c) { return static_cast<std::uint8_t>(title[at + 6 + c]); };
        if (!is_magics_ || (std::uint32_t{channel(0)} << 16 | std::uint32_t{channel(1)} << 8 | channel(2)) == kDefaultStlHeader) return;
        has_whole_ = true;
        for (std::size_t c = 0; c < 3; ++c) whole_[c] = channel(c);
    }
    /// Triangles without a colour of their own have the file's, instead of the usual grey.
    [[nodiscard]] bool has_whole() const { return has_whole_; }
    /// Number of a triangle's colour, 0 to 0x7fff; kNone: has none of its own. Bit 15: VisCAM sets it where there is a colour, Magics where
    /// there is none.
    [[nodiscard]] std::uint32_t number_of(std::uint16_t attribute) const {
        return has_none_ || ((attribute & 0x8000u) != 0) == is_magics_ ? kNone : attribute & 0x7fffu;
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
    bool is_magics_ = false, has_none_ = false, has_whole_ = false;
    std::uint8_t whole_[3] = {188, 188, 188};
    float linear_[32];
};

Soup read_binary(std::span<const std::byte> bytes, ModelBuilder& builder, bool& has_colors) {
    if (bytes.size() < kHeader)
        refuse("", fmt::format("a binary STL file has at least {} bytes, found {}: it was cut off", kHeader, bytes.size()));
    const std::uint64_t given = u32_at(bytes, kTitle), held = (bytes.size() - kHeader) / kRecord;
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
    const auto attribute_of = [&](std::size_t t) {
        const std::size_t at = kHeader + kRecord * t + 48;
        return static_cast<std::uint16_t>(u16_at(bytes, at));
    };
    std::uint32_t common = count == 0 ? kNone : attribute_of(0);
    for (std::size_t t = 1; t < count && common != kNone; ++t)
        if (attribute_of(t) != common) common = kNone;
    const StlColors colors(as_text(bytes.first(kTitle)), common);
    has_colors = colors.has_whole() || (common != kNone && colors.number_of(static_cast<std::uint16_t>(common)) != kNone);
    for (std::size_t t = 0; t < count && common == kNone && !has_colors; ++t) has_colors = colors.number_of(attribute_of(t)) != kNone;

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
        if (t % 65536 == 0) check_time(), TakenBytes::before(bytes.data() + kHeader + kRecord * t);
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
    return bytes.size() >= kHeader && bytes.size() == kHeader + std::uint64_t{kRecord} * u32_at(bytes, kTitle);
}

bool looks_like_binary_stl(std::span<const std::byte> bytes) {
    if (bytes.size() < kHeader + kRecord) return false;
    const std::uint32_t count = u32_at(bytes, kTitle);
    if ((count > 1u << 27 || count == 0) && (bytes.size() - kHeader) % kRecord != 0) return false;
    for (std::size_t i = 0; i < 12; ++i) {  // the normal, of any length, then three corners
        const float value = std::bit_cast<float>(u32_at(bytes, kHeader + 4 * i)), size = value < 0 ? -value : value;
        if (!(size <= 1e9f) || (size > 0 && size < 1e-12f)) return false;
    }
    return true;
}

LoadedScene read_stl(std::span<const std::byte> bytes, const std::string& /*base_dir*/, const LoadOptions& options) {
    ModelBuilder builder(bytes, "", options, "STL");
    bool has_colors = false;
    Soup soup;
    if (fits_binary_stl(bytes) || !begins_as_text(bytes)) {
        soup = read_binary(bytes, builder, has_colors);
    } else {
        soup = StlText(as_text(bytes), builder).read();
        has_colors = !soup.color_of.empty();
    }
    const int material = has_colors ? builder.colored_material() : builder.grey_material();
    builder.place_alone(std::move(soup), {&material, 1});
    return builder.finish({.up = UpAxis::z});
}

}  // namespace halflit::io::detail
