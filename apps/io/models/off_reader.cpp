// OFF, the Object File Format of Geomview: vertices, then polygons, as text. Headers with C, N and ST before OFF tell of colours, normals
// and texture coordinates of vertices; polygons may have a colour each.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/polygon.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace halflit::io::detail {

namespace {

class OffReader {
public:
    OffReader(std::string_view text, ModelBuilder& builder) : lines_(text), builder_(builder) {}

    void read() {
        Words words = next_line("OFF");
        std::string_view header = words.next();
        const auto has = [&header](std::string_view prefix) {
            const bool found = header.starts_with(prefix);
            if (found) header.remove_prefix(prefix.size());
            return found;
        };
        const bool uvs = has("ST"), colors = has("C"), normals = has("N");
        if (header.starts_with('4') || header.starts_with('n')) refuse(where(), "OFF files of other than three dimensions are not read");
        if (!has("OFF")) refuse(where(), fmt::format("expected OFF, found \"{}\"", printable(header, 40)));
        if (words.rest().starts_with("BINARY")) refuse(where(), "binary OFF files are not read");
        Words counts = header.empty() ? (words.rest().empty() ? next_line("the numbers of vertices and faces") : words)
                                      : Words(header_left(header));  // "OFF8 6 12" is written too
        const std::uint64_t vertices = count(counts, lines_.left()), faces = count(counts, lines_.left());
        read_vertices(vertices, normals, colors, uvs);
        for (std::uint64_t f = 0; f < faces; ++f) {
            if (f % 65536 == 0) check_time();
            read_face(next_line("a face"));
        }
        if (bad_faces_ > 0) builder_.document().warn(fmt::format("{} faces with indices out of range left out", bad_faces_));
        if (soup_.position_of.empty() && !soup_.positions.empty() && faces == 0) refuse("", "it has vertices but no faces");
    }

    void finish() {
        const bool has_colors = !soup_.colors.empty();
        const int material = has_colors ? builder_.colored_material() : builder_.grey_material();
        builder_.place_alone(std::move(soup_), std::array{material});
    }

private:
    [[nodiscard]] std::string where() const { return fmt::format("line {}", lines_.number()); }

    /// The words of the next line that has some, without its comment.
    Words next_line(const char* expected) {
        std::string_view line;
        while (lines_.next(line)) {
            line = line.substr(0, line.find('#'));
            if (!Words(line).next().empty()) return Words(line_ = line);
        }
        refuse(where(), fmt::format("expected {}, the file ends: it was cut off", expected));
    }
    /// The rest of the header's line from the numbers that follow OFF without a blank.
    [[nodiscard]] std::string_view header_left(std::string_view glued) const {
        return line_.substr(static_cast<std::size_t>(glued.data() - line_.data()));
    }

    /// A number of things of which each takes a byte of `text` at least.
    std::uint64_t count(Words& words, std::string_view text) {
        const std::string_view word = words.next();
        const auto number = parse_whole<std::uint64_t>(word);
        if (!number || *number > text.size())
            refuse(where(), fmt::format("expected a number of vertices, faces or corners, found \"{}\"", printable(word, 40)));
        return *number;
    }
    double number(Words& words) {
        const std::string_view word = words.next();
        const auto value = parse_real<double>(word);
        if (!value) refuse(where(), fmt::format("expected a number, found \"{}\"", printable(word, 40)));
        return *value;
    }
    Vec3d vector(Words& words) {
        const double x = number(words), y = number(words), z = number(words);
        return {x, y, z};
    }
    /// Three or four numbers up to the line's end: whole ones are sRGB codes, others shares. Nothing: another number of them.
    std::optional<Vec4f> color(Words& words) {
        double value[4] = {0, 0, 0, 1};
        int found = 0;
        bool codes = true;
        for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++found) {
            const auto share = parse_real<double>(word);
            if (found == 4 || !share) return std::nullopt;
            codes = codes && word.find_first_of(".eE") == std::string_view::npos;
            value[found] = *share;
        }
        if (found < 3) return std::nullopt;
        const double most = codes ? 255.0 : 1.0;
        return Vec4f{linear_color(value[0] / most), linear_color(value[1] / most), linear_color(value[2] / most), 1};
    }

    void read_vertices(std::uint64_t count, bool normals, bool colors, bool uvs) {
        builder_.take_entries<Vec3d>(count);
        builder_.take_entries<Vec4f>(count * ((normals ? 1 : 0) + (colors ? 1 : 0) + (uvs ? 1 : 0)));
        double most = 1;  // of all vertices: a dark code is no share
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) check_time();
            Words words = next_line("a vertex");
            soup_.positions.push_back(vector(words));
            if (normals) soup_.normals.push_back(rounded_near(vector(words), {}));
            if (colors) {
                float value[4];
                for (float& one : value) {
                    const double given = number(words);
                    if (given > 1) most = 255;
                    one = static_cast<float>(given);
                }
                soup_.colors.push_back({value[0], value[1], value[2], 1});
            }
            if (uvs) {
                const double u = number(words), v = number(words);
                soup_.uvs.push_back({static_cast<float>(u), static_cast<float>(1.0 - v)});
            }
        }
        for (Vec4f& color : soup_.colors)
            color = {linear_color(color.x / most), linear_color(color.y / most), linear_color(color.z / most), 1};
        has_normals_ = normals, has_colors_ = colors, has_uvs_ = uvs;
    }

    void read_face(Words words) {
        const std::uint64_t corners = count(words, line_);
        corners_.clear();
        points_.clear();
        triangles_.clear();
        bool good = true;
        for (std::uint64_t i = 0; i < corners; ++i) {
            const auto index = parse_whole<std::uint64_t>(words.next());
            if (!index) refuse(where(), fmt::format("expected {} numbers of vertices", corners));
            good = good && *index < soup_.positions.size();
            if (!good) continue;
            corners_.push_back(static_cast<std::uint32_t>(*index));
            points_.push_back(soup_.positions[corners_.back()]);
        }
        if (!good) {
            if (builder_.options().strict) refuse(where(), fmt::format("a vertex out of range: there are {}", soup_.positions.size()));
            ++bad_faces_;
            return;
        }
        if (corners < 3) return;  // edges and points, which belong to the faces
        builder_.take_triangles(corners - 2);
        cutter_.cut(points_, triangles_);
        std::optional<std::uint32_t> face_color;
        if (const auto own = has_colors_ ? std::nullopt : color(words)) {
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

    Lines lines_;
    std::string_view line_;
    ModelBuilder& builder_;
    Soup soup_;
    bool has_normals_ = false, has_colors_ = false, has_uvs_ = false;
    std::size_t bad_faces_ = 0;
    PolygonCutter cutter_;
    std::vector<std::uint32_t> corners_, triangles_;
    std::vector<Vec3d> points_;
};

}  // namespace

bool is_off_header(std::string_view word) {
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
        if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
    if (!word.starts_with("OFF")) return false;
    return word.find_first_not_of("0123456789", 3) == std::string_view::npos;
}

LoadedScene read_off(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "OFF");
    OffReader reader(as_text(bytes), builder);
    reader.read();
    reader.finish();
    return builder.finish({});
}

}  // namespace halflit::io::detail
