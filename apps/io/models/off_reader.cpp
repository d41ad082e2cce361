// OFF, the Object File Format of Geomview: vertices, then polygons, as text or binary. Headers with C, N and ST before OFF tell of colours,
// normals and texture coordinates of vertices; polygons may have a colour each.
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_colors.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/polygon.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

namespace halflit::io::detail {

namespace {

/// The word without Geomview's prefixes, which say what a vertex has.
struct OffHeader {
    bool uvs = false, colors = false, normals = false, other_space = false, is_off = false;
    std::string_view behind;  ///< "OFF8 6 12" is written too

    explicit OffHeader(std::string_view word) {
        const auto has = [&word](std::string_view prefix) {
            const bool found = word.starts_with(prefix);
            if (found) word.remove_prefix(prefix.size());
            return found;
        };
        if (same_word(word, "off")) word = "OFF";
        uvs = has("ST");
        colors = has("C");
        normals = has("N");
        other_space = has("4");
        other_space = has("n") || other_space;
        is_off = has("OFF") && word.find_first_not_of("0123456789") == std::string_view::npos;
        behind = word;
    }
};

/// Numbers of the body: words wherever lines end, or binary ones of 32 bits, the high byte first.
class OffValues {
public:
    explicit OffValues(TextScanner& scanner) : scanner_(scanner) {}
    void begin_binary() {
        scanner_.skip_line();
        std::string_view left = scanner_.left();
        left.remove_prefix(left.starts_with("\r\n") ? 2 : left.empty() ? 0 : 1);
        binary_ = left;
    }
    [[nodiscard]] bool is_binary() const { return binary_.has_value(); }
    /// Bytes that are left.
    [[nodiscard]] std::size_t left() const { return binary_ ? binary_->size() : scanner_.left().size(); }
    std::optional<std::uint64_t> count() { return binary_ ? std::optional<std::uint64_t>(take()) : scanner_.count(); }
    double number() { return binary_ ? static_cast<double>(std::bit_cast<float>(take())) : scanner_.number(); }
    Vec3d vector() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }

private:
    std::uint32_t take() {
        if (binary_->size() < 4) throw CutOff{};
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>((*binary_)[i]);
        binary_->remove_prefix(4);
        return value;
    }

    TextScanner& scanner_;
    std::optional<std::string_view> binary_;
};

class OffReader {
public:
    OffReader(std::string_view text, ModelBuilder& builder) : scanner_(text, builder.document()), values_(scanner_), builder_(builder) {}

    void read() {
        const std::string_view word = scanner_.word();
        const OffHeader header(word);
        if (header.other_space) refuse(scanner_.where(), "OFF files of other than three dimensions are not read");
        if (!header.is_off) scanner_.refuse_word(word, "OFF");
        if (same_word(scanner_.next_in_line(), "binary")) values_.begin_binary();
        has_uvs_ = header.uvs, has_colors_ = header.colors, has_normals_ = header.normals;
        scanner_.expect_next("the numbers of vertices and faces");
        std::uint64_t read_faces = 0, vertices = 0, faces = 0;
        try {
            vertices = things(header.behind.empty() ? values_.count() : TextScanner::parse_count(header.behind));
            faces = things(values_.count());
            pass_edges();
            scanner_.expect_next("a vertex");
            read_vertices(vertices);
            scanner_.expect_next("a face");
            for (; read_faces < faces; ++read_faces) {
                if (read_faces % 65536 == 0) check_time();
                read_face();
            }
        } catch (const CutOff&) {
            if (builder_.options().strict) refuse("", "the file ends before its last face: it was cut off");
            builder_.document().go_on_without(
                {{ErrorCode::bad_input, fmt::format("it was cut off: {} of {} vertices and {} of {} faces are there",
                                                    soup_.positions.size(), vertices, read_faces, faces)}},
                "the rest is left out");
        }
        finish_colors();
        scanner_.warn();
        if (bad_faces_ > 0) builder_.document().warn(fmt::format("{} faces with indices out of range left out", bad_faces_));
    }

    void finish() {
        if (soup_.position_of.empty() && bad_faces_ == 0 && !soup_.positions.empty()) return builder_.place_points(std::move(soup_));
        const bool has_colors = !soup_.color_of.empty();
        const int material = has_colors ? builder_.colored_material() : builder_.grey_material();
        builder_.place_alone(std::move(soup_), std::array{material});
    }

private:
    /// A number of things of which each takes a byte at least.
    std::uint64_t things(std::optional<std::uint64_t> number) {
        if (!number || *number > values_.left())
            refuse(scanner_.where(), number ? fmt::format("{} vertices, faces or corners do not fit into the file", *number)
                                            : "expected a number of vertices, faces or corners");
        return *number;
    }
    /// The number of edges, which few writers leave out, stands behind that of faces, or alone on the next line.
    void pass_edges() {
        if (values_.is_binary()) return void(values_.count());
        if (!scanner_.word_in_line().empty()) return;
        scanner_.go_to_word();
        if (scanner_.words_in_line(2) == 1) scanner_.word();
    }
    /// The line of the row that comes next; 0 where it does not begin with a line.
    std::size_t line_of_row() { return !values_.is_binary() && scanner_.go_to_word() && scanner_.is_at_line_begin() ? scanner_.line() : 0; }
    /// Words that a line has behind a row that takes one line; 0 where rows are not lines.
    [[nodiscard]] std::size_t more_in_line(std::size_t row_line) const {
        return row_line == scanner_.line() ? scanner_.words_in_line(16) : 0;
    }
    /// Whether the words up to the line's end look like a colour: shares, or codes.
    [[nodiscard]] bool color_comes(std::size_t words) {
        const TextScanner::Mark here = scanner_.mark();
        double value = 0, most = 1;
        bool are_whole = true, are_codes = true;
        for (std::size_t i = 0; i < words && are_codes; ++i) {
            are_codes = scanner_.take_number(value) && value >= 0 && value <= 255;
            most = std::max(most, value);
            are_whole = are_whole && are_codes && value == static_cast<double>(static_cast<int>(value));
        }
        scanner_.go_back(here);
        return are_codes && (most <= 1 || are_whole);
    }

    void read_vertices(std::uint64_t count) {
        // Each number takes a byte: lists are no longer than the file.
        builder_.take_entries<Vec3d>(count);
        builder_.take_entries<Vec4f>(count * ((has_normals_ ? 1 : 0) + 1 + (has_uvs_ ? 1 : 0)));
        std::size_t channels = 4;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) check_time();
            const std::size_t line = line_of_row();
            const Vec3d position = values_.vector();
            const Vec3d normal = has_normals_ ? values_.vector() : Vec3d{};
            if (i == 0) {  // the first vertex tells how many numbers its colour has; files without C in their header have some too
                const std::size_t more = more_in_line(line), of_uv = has_uvs_ ? 2 : 0;
                if ((more == 3 + of_uv || more == 4 + of_uv) && color_comes(more - of_uv)) has_colors_ = true, channels = more - of_uv;
                if (has_colors_ && more == 1 + of_uv) channels = 1;  // of a table that no file has
            }
            double color[4] = {1, 1, 1, 1};
            for (std::size_t c = 0; c < channels && has_colors_; ++c) color[c] = values_.number();
            const double u = has_uvs_ ? values_.number() : 0, v = has_uvs_ ? values_.number() : 0;
            if (more_in_line(line) > 0) scanner_.pass_long_row();
            soup_.positions.push_back(position);
            if (has_normals_) soup_.normals.push_back(rounded_near(normal, {}));
            if (has_uvs_) soup_.uvs.push_back({static_cast<float>(u), static_cast<float>(1.0 - v)});
            if (!has_colors_ || channels == 1) continue;
            soup_.colors.push_back(rounded(color));
            vertex_colors_ = soup_.colors.size();
        }
        has_colors_ = has_colors_ && channels > 1;
    }
    static Vec4f rounded(const double (&color)[4]) {
        return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]), static_cast<float>(color[3])};
    }
    /// Colours are codes where one is above 1, alpha included: a dark code is no share.
    void finish_colors() {
        const auto make = [](std::span<Vec4f> colors) {
            const bool are_codes =
                std::any_of(colors.begin(), colors.end(), [](const Vec4f& c) { return c.x > 1 || c.y > 1 || c.z > 1 || c.w > 1; });
            make_linear(colors, are_codes ? 255 : 1);
            for (Vec4f& c : colors) c.w = 1;
        };
        make(std::span(soup_.colors).first(vertex_colors_));
        for (Vec4f& c : std::span(soup_.colors).subspan(vertex_colors_)) {
            if (most_code_ == 1) c = {c.x > 0 ? 1.0f : 0.0f, c.y > 0 ? 1.0f : 0.0f, c.z > 0 ? 1.0f : 0.0f, 1};  // shares: 1 0 0 is red
            c.w = 1;
        }
        drop_no_colors(ModelFormat::off, soup_, builder_.document());
    }

    /// Three or four numbers up to the line's end: whole ones are sRGB codes, others shares. Nothing: another number of them, or a face.
    std::optional<Vec4f> color(std::size_t words) {
        if (words < 3 || words > 4) return std::nullopt;
        double value[4] = {0, 0, 0, 1};
        bool codes = true;
        for (std::size_t i = 0; i < words; ++i) {
            const std::string_view word = scanner_.next_in_line();
            codes = codes && word.find_first_of(".eE") == std::string_view::npos;
            if (!scanner_.take_number(value[i])) return std::nullopt;
        }
        for (std::size_t i = 0; i < 3; ++i) most_code_ = std::max(most_code_, codes ? value[i] : 255.0);
        std::array<Vec4f, 1> made{rounded(value)};
        make_linear(made, codes ? 255 : 1);
        return made[0];
    }
    std::optional<Vec4f> binary_color() {
        const std::uint64_t channels = values_.count().value_or(0);
        if (channels > 16) throw CutOff{};
        double value[4] = {0, 0, 0, 1};
        for (std::uint64_t c = 0; c < channels; ++c) {
            const double one = values_.number();
            if (c < 4) value[c] = one;
        }
        if (channels < 3) return std::nullopt;
        std::array<Vec4f, 1> made{rounded(value)};
        make_linear(made, 1);
        return made[0];
    }

    void read_face() {
        const std::size_t line = line_of_row();
        const std::uint64_t corners = things(values_.count());
        corners_.clear();
        points_.clear();
        triangles_.clear();
        bool good = true;
        for (std::uint64_t i = 0; i < corners; ++i) {
            const auto index = values_.count();
            if (builder_.options().strict && !index) refuse(scanner_.where(), fmt::format("expected {} numbers of vertices", corners));
            good = good && index && *index < soup_.positions.size();
            if (!good) continue;
            corners_.push_back(static_cast<std::uint32_t>(*index));
            points_.push_back(soup_.positions[corners_.back()]);
        }
        const std::size_t more = more_in_line(line);
        const bool is_another = more > 1 && TextScanner::parse_count(scanner_.next_in_line()) == more - 1;  // face, on the same line
        const auto own = values_.is_binary() ? binary_color() : is_another ? std::nullopt : color(more);
        if (more > 0 && more <= 4 && !is_another) scanner_.skip_line();
        if (!good) {
            if (builder_.options().strict)
                refuse(scanner_.where(), fmt::format("a vertex out of range: there are {}", soup_.positions.size()));
            ++bad_faces_;
            return;
        }
        if (corners < 3) return;  // edges and points, which belong to the faces
        builder_.take_triangles(corners - 2);
        cutter_.cut(points_, triangles_);
        std::optional<std::uint32_t> face_color;
        if (own && !has_colors_) {
            builder_.take_entries<Vec4f>(1);
            face_color = static_cast<std::uint32_t>(soup_.colors.size());
            soup_.colors.push_back(*own);
            soup_.color_of.resize(soup_.position_of.size(), kNone);
        }
        for (const std::uint32_t i : triangles_) {
            const std::uint32_t corner = corners_[i];
            soup_.position_of.push_back(corner);
            if (has_normals_) soup_.normal_of.push_back(corner);
            if (has_uvs_) soup_.uv_of.push_back(corner);
            if (has_colors_ || face_color) soup_.color_of.push_back(face_color.value_or(corner));
        }
    }

    TextScanner scanner_;
    OffValues values_;
    ModelBuilder& builder_;
    Soup soup_;
    bool has_normals_ = false, has_colors_ = false, has_uvs_ = false;  ///< of vertices
    double most_code_ = 0;  ///< of faces' colours, all of which are whole numbers; 255: some are not
    std::size_t vertex_colors_ = 0, bad_faces_ = 0;
    PolygonCutter cutter_;
    std::vector<std::uint32_t> corners_, triangles_;
    std::vector<Vec3d> points_;
};

}  // namespace

bool is_off_header(std::string_view word) { return OffHeader(word).is_off; }

LoadedScene read_off(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "OFF");
    OffReader reader(as_text(bytes), builder);
    reader.read();
    reader.finish();
    return builder.finish({});
}

}  // namespace halflit::io::detail
