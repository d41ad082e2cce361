// OBJ: polygons, lines and points as text, with the materials of MTL files. Own code, as the library tinyobjloader rounds its numbers by
// pow() of the C library, and has no limit on memory, time or the files that it opens.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/mtl_libraries.hpp"
#include "apps/io/models/obj_strokes.hpp"
#include "apps/io/models/polygon.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace halflit::io::detail {

namespace {

/// A corner of a face: numbers in the file's lists.
struct Corner {
    std::uint32_t position, uv, normal;
};

class ObjReader {
public:
    ObjReader(std::string_view text, ModelBuilder& builder) : lines_(text), builder_(builder), libraries_(builder), strokes_(builder) {}

    void read() {
        std::string_view line;
        std::string joined;
        while (lines_.next(line)) {
            if (lines_.number() % 65536 == 0) check_time();
            line = without_comment(line);
            if (line.ends_with('\\')) {
                joined.clear();
                do {
                    joined.append(line.substr(0, line.size() - 1)).push_back(' ');
                } while (lines_.next(line) && line.ends_with('\\'));
                joined.append(line);
                line = without_comment(joined);
            }
            read_statement(line);
        }
        read_late_faces();
        if (soup_.position_of.empty() && strokes_.empty() && bad_faces_ == 0 && !soup_.positions.empty()) {
            if (builder_.options().strict) refuse("", "it has vertices but no faces, lines or points");
            std::vector<std::uint32_t> all(soup_.positions.size());
            std::iota(all.begin(), all.end(), 0u);
            strokes_.add(current_part(), Topology::points, all);
        }
        if (free_form_ > 0) builder_.document().warn("curves and free-form surfaces are not drawn");
        if (bad_faces_ > 0)
            builder_.document().warn(fmt::format("{} faces, lines or points with indices out of range left out", bad_faces_));
        if (lost_attributes_ > 0)
            builder_.document().warn(
                fmt::format("{} corners have a texture coordinate or normal out of range, and are drawn without it", lost_attributes_));
        if (short_faces_ > 0) builder_.document().warn(fmt::format("{} faces of less than three corners left out", short_faces_));
    }

    void finish() {
        std::vector<int> materials;
        std::vector<std::string> names;
        for (const Part& part : parts_) {
            const bool is_plain = part.material < 0;
            materials.push_back(!is_plain ? part.material : part.has_colors ? builder_.colored_material() : builder_.grey_material());
            names.push_back(objects_[part.object]);
        }
        std::map<std::uint32_t, std::vector<int>> meshes_of;  // of an object
        for (const PartMesh& made : strokes_.add_meshes(soup_.positions, soup_.colors, materials, names))
            meshes_of[parts_[made.part].object].push_back(made.mesh);
        for (const PartMesh& made : builder_.add_meshes(std::move(soup_), names, materials))
            meshes_of[parts_[made.part].object].push_back(made.mesh);
        for (const auto& [object, meshes] : meshes_of) builder_.place(meshes, objects_[object]);
    }

    void add_files() {
        std::string_view line;
        while (lines_.next(line)) {
            Words words(without_comment(line));
            if (words.next() == "mtllib") libraries_.add(words.rest());
        }
        libraries_.add_files();
    }

private:
    /// What becomes one mesh: the faces of an object with one material.
    struct Part {
        std::uint32_t object;
        int material;
        bool has_colors;
    };

    /// Without a comment, which begins a word: "wood#1" is a name.
    static std::string_view without_comment(std::string_view line) {
        for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1))
            if (at == 0 || is_blank(line[at - 1])) return line.substr(0, at);
        return line;
    }
    [[nodiscard]] std::string where() const { return fmt::format("line {}", lines_.number()); }

    void read_statement(std::string_view line) {
        Words words(line);
        const std::string_view word = words.next();
        if (word.empty()) return;
        if (word == "v") return read_position(words);
        if (word == "vt") {
            const Vec3d uv = read_numbers(words, 1);
            const Vec3f rounded = fits_float(uv) ? rounded_near(uv, {}) : Vec3f{};
            builder_.take_entries<Vec2f>(1);
            return soup_.uvs.push_back({rounded.x, 1.0f - rounded.y});
        }
        if (word == "vn") {
            builder_.take_entries<Vec3f>(1);
            return soup_.normals.push_back(rounded_near(read_numbers(words, 3), {}));
        }
        if (word == "f" || word == "fo") return read_face(words);
        if (word == "usemtl") return use_material(std::string(words.rest()));
        if (word == "mtllib") return libraries_.add(words.rest());
        if (word == "o") {
            builder_.document().geometry.take(sizeof(std::string) + line.size());
            objects_.emplace_back(words.rest());
            part_ = kNone;
            return;
        }
        if (word == "s") return read_smoothing(words.next());
        if (word == "l") return read_stroke(words, Topology::lines);
        if (word == "p") return read_stroke(words, Topology::points);
        if (word == "curv" || word == "curv2" || word == "surf") ++free_form_;
    }

    /// Up to three numbers, at least `least`.
    Vec3d read_numbers(Words& words, std::size_t least) {
        std::array<double, 3> value{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view word = words.next();
            if (word.empty() && i >= least) break;
            const auto number = builder_.options().strict ? parse_real<double>(word) : parse_loosely(word);
            if (!number) refuse(where(), fmt::format("expected a number, found \"{}\"", printable(word, 40)));
            value[i] = *number;
        }
        return {value[0], value[1], value[2]};
    }

    /// x y z, and after them a weight, which surfaces alone use, or red, green and blue.
    void read_position(Words& words) {
        builder_.take_entries<Vec3d>(1);
        soup_.positions.push_back(read_numbers(words, 3));
        Words more = words;
        more.next(), more.next();
        if (more.next().empty()) return;
        const Vec3d color = read_numbers(words, 3);
        builder_.take_entries<Vec4f>(1 + soup_.positions.size() - soup_.colors.size());
        soup_.colors.resize(soup_.positions.size() - 1, Vec4f{1, 1, 1, 1});
        soup_.colors.push_back({linear_color(color.x), linear_color(color.y), linear_color(color.z), 1});
    }

    void read_smoothing(std::string_view word) {
        const auto group = parse_whole<std::uint32_t>(word);
        smoothing_ = group ? std::min(*group, kNone - 1) : 0;  // "off"
    }

    void use_material(std::string name) {
        if (name == material_name_ && has_material_name_) return;
        material_name_ = std::move(name);
        has_material_name_ = true;
        material_is_known_ = false;
        part_ = kNone;
    }

    /// The part of the next face.
    std::uint32_t current_part() {
        const bool has_colors = !soup_.colors.empty();
        if (part_ != kNone && parts_[part_].has_colors == has_colors) return part_;
        if (!material_is_known_) material_ = has_material_name_ ? libraries_.find(material_name_) : -1;
        material_is_known_ = true;
        const auto object = static_cast<std::uint32_t>(objects_.size() - 1);
        const auto [entry, is_new] = part_at_.try_emplace({object, material_, has_colors}, static_cast<std::uint32_t>(parts_.size()));
        if (is_new) {
            builder_.document().geometry.take(128);
            parts_.push_back({object, material_, has_colors});
        }
        return part_ = entry->second;
    }

    /// An index counts from 1, or back from the last entry so far. False: it is out of range.
    static bool resolve(std::int64_t index, std::size_t count, std::uint32_t& out) {
        const std::int64_t n = static_cast<std::int64_t>(count), at = index < 0 ? n + index : index - 1;
        out = static_cast<std::uint32_t>(at);
        return index != 0 && at >= 0 && at < n;
    }

    /// v, v/vt, v//vn or v/vt/vn.
    bool read_corner(std::string_view word, Corner& corner) {
        corner = {kNone, kNone, kNone};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t slash = std::min(word.find('/'), word.size());
            const std::string_view text = word.substr(0, slash);
            word.remove_prefix(slash < word.size() ? slash + 1 : slash);
            if (text.empty() && i > 0) continue;
            const auto index = parse_whole<std::int64_t>(text);
            if (!index) refuse(where(), fmt::format("expected an index, found \"{}\"", printable(text, 40)));
            const std::size_t count = i == 0 ? soup_.positions.size() : i == 1 ? soup_.uvs.size() : soup_.normals.size();
            std::uint32_t& number = i == 0 ? corner.position : i == 1 ? corner.uv : corner.normal;
            if (resolve(*index, count, number)) continue;
            if (!builder_.options().strict && i > 0) {
                number = kNone;
                ++lost_attributes_;
                continue;
            }
            if (builder_.options().strict)
                refuse(where(), fmt::format("the index {} is out of range: {} {} came before", *index, count,
                                            i == 0   ? "vertices"
                                            : i == 1 ? "texture coordinates"
                                                     : "normals"));
            return false;
        }
        return true;
    }

    /// A face whose vertices come after it.
    struct LateFace {
        std::string corners, material;
        bool has_material;
        std::uint32_t smoothing;
    };
    [[nodiscard]] bool is_late(Words words) const {
        if (builder_.options().strict || late_are_read_) return false;
        bool late = false;
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const auto index = parse_whole<std::int64_t>(word.substr(0, word.find('/')));
            if (!index || *index <= 0) return false;  // those that count back are known
            late = late || static_cast<std::uint64_t>(*index) > soup_.positions.size();
        }
        return late;
    }
    void put_off(const Words& words) {
        builder_.document().geometry.take(sizeof(LateFace) + words.rest().size() + material_name_.size());
        late_.push_back({std::string(words.rest()), material_name_, has_material_name_, smoothing_});
    }
    void read_late_faces() {
        late_are_read_ = true;
        for (std::size_t i = 0; i < late_.size(); ++i) {
            if (i % 65536 == 0) check_time();
            if (late_[i].has_material) use_material(late_[i].material);
            smoothing_ = late_[i].smoothing;
            Words words(late_[i].corners);
            read_face(words);
        }
        late_.clear();
    }

    /// A polyline, or points.
    void read_stroke(Words& words, Topology topology) {
        std::vector<std::uint32_t> corners;
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            Corner corner{};
            if (!read_corner(word, corner)) return void(++bad_faces_);
            corners.push_back(corner.position);
        }
        if (topology == Topology::lines && corners.size() < 2) {
            if (builder_.options().strict) refuse(where(), "a line has one corner, expected at least 2");
            return void(++short_faces_);
        }
        strokes_.add(current_part(), topology, corners);
    }

    void read_face(Words& words) {
        if (is_late(words)) return put_off(words);
        face_.clear();
        points_.clear();
        triangles_.clear();
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            Corner corner{};
            if (!read_corner(word, corner)) return void(++bad_faces_);
            face_.push_back(corner);
            points_.push_back(soup_.positions[corner.position]);
        }
        if (face_.size() < 3) {
            if (builder_.options().strict) refuse(where(), fmt::format("a face has {} corners, expected at least 3", face_.size()));
            return void(++short_faces_);
        }
        const std::uint32_t part = current_part();
        const bool drops_colors =
            parts_[part].material >= 0 &&
            builder_.loaded().scene.materials[static_cast<std::size_t>(parts_[part].material)].textures[TextureSlot::base_color].used();
        builder_.take_triangles(face_.size() - 2);
        cutter_.cut(points_, triangles_);
        soup_.part_of.insert(soup_.part_of.end(), triangles_.size() / 3, part);
        soup_.smoothing_of.insert(soup_.smoothing_of.end(), triangles_.size() / 3, smoothing_);
        for (const std::uint32_t i : triangles_) {
            const Corner& corner = face_[i];
            soup_.position_of.push_back(corner.position);
            soup_.uv_of.push_back(corner.uv);
            soup_.normal_of.push_back(corner.normal);
            soup_.color_of.push_back(!drops_colors && corner.position < soup_.colors.size() ? corner.position : kNone);
        }
    }

    Lines lines_;
    ModelBuilder& builder_;
    MtlLibraries libraries_;
    ObjStrokes strokes_;
    Soup soup_;
    PolygonCutter cutter_;
    std::vector<std::string> objects_{""};
    std::vector<Part> parts_;
    std::map<std::tuple<std::uint32_t, int, bool>, std::uint32_t> part_at_;
    std::string material_name_;
    bool has_material_name_ = false, material_is_known_ = true;
    int material_ = -1;
    std::uint32_t part_ = kNone, smoothing_ = Soup::kByCrease;
    std::vector<Corner> face_;
    std::vector<Vec3d> points_;
    std::vector<std::uint32_t> triangles_;
    std::vector<LateFace> late_;
    bool late_are_read_ = false;
    std::size_t free_form_ = 0, bad_faces_ = 0, short_faces_ = 0, lost_attributes_ = 0;
};

std::string_view text_of(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

}  // namespace

LoadedScene read_obj(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "OBJ");
    ObjReader reader(text_of(bytes), builder);
    reader.read();
    reader.finish();
    return builder.finish({});
}

std::vector<std::string> files_of_obj(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "OBJ");
    ObjReader(text_of(bytes), builder).add_files();
    return builder.finish({}).info.files;
}

}  // namespace halflit::io::detail
