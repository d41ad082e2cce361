// OBJ: polygons, lines and points as text, with the materials of MTL files. Own code, as the library tinyobjloader rounds its numbers by
// pow() of the C library, and has no limit on memory, time or the files that it opens.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_colors.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/mtl_libraries.hpp"
#include "apps/io/models/obj_strokes.hpp"
#include "apps/io/models/obj_words.hpp"
#include "apps/io/models/polygon.hpp"
#include "apps/io/models/text_scanner.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>

namespace halflit::io::detail {

namespace {

/// A corner of a face: numbers in the file's lists.
struct Corner {
    std::uint32_t position, uv, normal;
};

class ObjReader {
public:
    ObjReader(const ModelFile& file, ModelBuilder& builder)
        : scanner_(as_text(file.bytes), builder.document(), "", true),
          builder_(builder),
          libraries_(builder, file.name),
          strokes_(builder) {}

    void read() {
        scanner_.keep_comments("#MRGB ", painted_);
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            read_statement(word);
            scanner_.skip_line();
        }
        read_late();
        finish_colors();
        if (soup_.position_of.empty() && strokes_.empty() && bad_faces_ == 0 && !soup_.positions.empty()) {
            if (builder_.options().strict) refuse("", "it has vertices but no faces, lines or points");
            std::vector<std::uint32_t> all(soup_.positions.size());
            std::iota(all.begin(), all.end(), 0u);
            strokes_.add(current_part(), Topology::points, all);
        }
        scanner_.warn();
        if (free_form_ > 0) builder_.document().warn("curves and free-form surfaces are not drawn");
        if (bad_faces_ > 0)
            builder_.document().warn(fmt::format("{} faces, lines or points with indices out of range left out", bad_faces_));
        if (lost_attributes_ > 0)
            builder_.document().warn(
                fmt::format("{} corners have a texture coordinate or normal out of range, and are drawn without it", lost_attributes_));
        if (short_faces_ > 0) builder_.document().warn(fmt::format("{} faces of less than three corners left out", short_faces_));
    }

    void finish() {
        libraries_.add_files();
        std::vector<int> materials;
        std::vector<std::string> names;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const Part& part = parts_[i];
            materials.push_back(part.material >= 0 ? part.material
                                : part.has_colors  ? builder_.colored_material()
                                                   : builder_.grey_material());
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
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            const ObjWord* const row = find_obj_word(word);
            if (row == nullptr || row->statement == ObjStatement::of_mtl) libraries_.take_statement(word, scanner_);
            if (row != nullptr && row->statement == ObjStatement::library) libraries_.add(scanner_.rest_of_line());
            if (row != nullptr && row->statement == ObjStatement::material)
                libraries_.look_up(std::string(unquoted(scanner_.rest_of_line(true))));
            scanner_.skip_line();
        }
        libraries_.add_files();
    }

private:
    /// Faces that become one mesh: those of an object with one material.
    struct Part {
        std::uint32_t object;
        int material;
        bool has_colors;
    };

    void read_statement(std::string_view word) {
        const ObjWord* const row = find_obj_word(word);
        if (row != nullptr && row->word != word) scanner_.loose(word, "a statement in small letters");
        switch (row == nullptr ? ObjStatement::of_mtl : row->statement) {
            case ObjStatement::position:
                return read_position();
            case ObjStatement::uv:
                return read_uv();
            case ObjStatement::normal:
                builder_.take_entries<Vec3f>(1);
                return soup_.normals.push_back(rounded_near(read_vector(), {}));
            case ObjStatement::face:
                return read_element(Topology::triangles);
            case ObjStatement::lines:
                return read_element(Topology::lines);
            case ObjStatement::points:
                return read_element(Topology::points);
            case ObjStatement::object:
                return begin_object(scanner_.rest_of_line(true));
            case ObjStatement::smoothing:
                return read_smoothing(scanner_.word_in_line());
            case ObjStatement::material:
                return use_material(std::string(unquoted(scanner_.rest_of_line(true))));
            case ObjStatement::library:
                return libraries_.add(scanner_.rest_of_line());
            case ObjStatement::free_form:
                ++free_form_;
                return;
            case ObjStatement::passed_over:
                return;
            case ObjStatement::of_mtl:
                if (!libraries_.take_statement(word, scanner_)) scanner_.unknown(word, "a statement of OBJ");
                return;
        }
    }

    void read_uv() {
        const double u = scanner_.number_in_line();
        double v = 0;
        scanner_.take_number(v);
        builder_.take_entries<Vec2f>(1);
        const Vec3d uv{u, v, 0};
        const Vec3f rounded = fits_float(uv) ? rounded_near(uv, {}) : Vec3f{};
        soup_.uvs.push_back({rounded.x, 1.0f - rounded.y});
    }

    void begin_object(std::string_view name) {
        builder_.document().geometry.take(sizeof(std::string) + name.size());
        object_ = static_cast<std::uint32_t>(objects_.size());
        objects_.emplace_back(name);
        part_ = kNone;
    }

    Vec3d read_vector() {
        const double x = scanner_.number_in_line(), y = scanner_.number_in_line(), z = scanner_.number_in_line();
        return {x, y, z};
    }

    /// x y z, and after them a weight, which surfaces alone use, or red, green and blue.
    void read_position() {
        builder_.take_entries<Vec3d>(1);
        soup_.positions.push_back(read_vector());
        double color[3];
        std::size_t found = 0;
        while (found < 3 && scanner_.take_number(color[found])) ++found;
        if (found < 3) return;
        builder_.take_entries<Vec4f>(1 + soup_.positions.size() - soup_.colors.size());
        soup_.colors.resize(soup_.positions.size() - 1, kNoColor);
        soup_.colors.push_back({static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]), 1});
    }

    /// ZBrush writes colours into comments: eight hexadecimal digits a vertex, of a mask and of red, green and blue.
    void read_painted() {
        constexpr std::size_t kDigits = 8;
        for (const std::string_view codes : painted_) {
            for (std::size_t at = 0; at + kDigits <= codes.size() && soup_.colors.size() < soup_.positions.size(); at += kDigits) {
                std::uint32_t value = 0;
                const auto [end, error] = std::from_chars(codes.data() + at, codes.data() + at + kDigits, value, 16);
                if (error != std::errc() || end != codes.data() + at + kDigits) break;
                builder_.take_entries<Vec4f>(1);
                soup_.colors.push_back(
                    {static_cast<float>(value >> 16 & 255u), static_cast<float>(value >> 8 & 255u), static_cast<float>(value & 255u), 1});
            }
        }
        make_linear(soup_.colors, 255);
    }

    /// Which corners have colours, and so which parts: vertices without one are white beside others.
    void finish_colors() {
        const auto has_color = [](const Vec4f& c) { return c.w != kNoColor.w; };
        if (soup_.colors.empty()) {
            read_painted();
        } else {
            make_linear_by_range(soup_.colors, false, builder_.document());
        }
        drop_no_colors(ModelFormat::obj, soup_, builder_.document());
        if (soup_.colors.empty()) return;
        for (std::size_t i = 0; i < soup_.position_of.size(); ++i) {
            const std::uint32_t position = soup_.position_of[i];
            Part& part = parts_[soup_.part_of[i / 3]];
            part.has_colors = part.has_colors || (position < soup_.colors.size() && has_color(soup_.colors[position]));
        }
        strokes_.for_each_corner([&](std::uint32_t part, std::uint32_t position) {
            parts_[part].has_colors = parts_[part].has_colors || (position < soup_.colors.size() && has_color(soup_.colors[position]));
        });
        std::vector<bool> keeps(parts_.size());
        for (std::size_t p = 0; p < parts_.size(); ++p) keeps[p] = parts_[p].has_colors && !has_picture(parts_[p]);
        builder_.take_entries<std::uint32_t>(soup_.position_of.size());
        soup_.color_of.resize(soup_.position_of.size(), kNone);
        for (std::size_t i = 0; i < soup_.position_of.size(); ++i)
            if (keeps[soup_.part_of[i / 3]] && soup_.position_of[i] < soup_.colors.size()) soup_.color_of[i] = soup_.position_of[i];
        for (Vec4f& c : soup_.colors)
            if (!has_color(c)) c = {1, 1, 1, 1};
    }
    [[nodiscard]] bool has_picture(const Part& part) const {
        return part.material >= 0 &&
               builder_.loaded().scene.materials[static_cast<std::size_t>(part.material)].textures[TextureSlot::base_color].used();
    }

    void read_smoothing(std::string_view word) {
        const auto group = parse_whole<std::uint32_t>(word);
        smoothing_ = group ? std::min(*group, kNone - 1) : 0;  // "off"
    }

    void use_material(std::optional<std::string> name) {
        if (name == material_name_) return;
        material_name_ = std::move(name);
        material_is_known_ = false;
        part_ = kNone;
    }

    /// The part of the next face.
    std::uint32_t current_part() {
        if (part_ != kNone) return part_;
        if (!material_is_known_) material_ = material_name_ ? libraries_.find(*material_name_) : -1;
        material_is_known_ = true;
        const auto [entry, is_new] = part_at_.try_emplace({object_, material_}, static_cast<std::uint32_t>(parts_.size()));
        if (is_new) {
            builder_.document().geometry.take(128);
            parts_.push_back({object_, material_, false});
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
            if (!index) {
                scanner_.wrong(text, "an index");
                if (i > 0) continue;
                return false;
            }
            const std::size_t count = i == 0 ? soup_.positions.size() : i == 1 ? soup_.uvs.size() : soup_.normals.size();
            std::uint32_t& number = i == 0 ? corner.position : i == 1 ? corner.uv : corner.normal;
            if (resolve(*index, count, number)) continue;
            if (!builder_.options().strict && i > 0) {
                number = kNone;
                ++lost_attributes_;
                continue;
            }
            if (builder_.options().strict)
                refuse(scanner_.where(), fmt::format("the index {} is out of range: {} {} came before", *index, count,
                                                     i == 0   ? "vertices"
                                                     : i == 1 ? "texture coordinates"
                                                              : "normals"));
            return false;
        }
        return true;
    }

    /// A face, polyline or points whose vertices come after it.
    struct Late {
        TextScanner::Mark corners;
        Topology topology;
        std::uint32_t object, smoothing;
        std::optional<std::string> material;
    };
    /// True if vertices of the corners that come next are not there yet.
    [[nodiscard]] bool is_late() {
        bool late = false;
        for (std::string_view word = scanner_.bare_word_in_line(); !word.empty(); word = scanner_.bare_word_in_line()) {
            const auto index = parse_whole<std::int64_t>(word.substr(0, word.find('/')));
            if (!index || *index <= 0) return false;  // those that count back are known
            late = late || static_cast<std::uint64_t>(*index) > soup_.positions.size();
        }
        return late;
    }
    void read_late() {
        late_are_read_ = true;
        for (std::size_t i = 0; i < late_.size(); ++i) {
            if (i % 65536 == 0) check_time();
            scanner_.go_back(late_[i].corners);
            object_ = late_[i].object;
            part_ = kNone;
            smoothing_ = late_[i].smoothing;
            use_material(std::move(late_[i].material));
            read_element(late_[i].topology);
        }
        late_.clear();
    }

    /// A face, polyline or points.
    void read_element(Topology topology) {
        const TextScanner::Mark begin = scanner_.mark();
        const std::size_t lost = lost_attributes_;
        corners_.clear();
        for (std::string_view word = scanner_.bare_word_in_line(); !word.empty(); word = scanner_.bare_word_in_line()) {
            if (read_corner(word, corners_.emplace_back())) continue;
            scanner_.go_back(begin);
            if (late_are_read_ || !is_late()) return void(++bad_faces_);
            lost_attributes_ = lost;
            builder_.document().geometry.take(sizeof(Late) + (material_name_ ? material_name_->size() : 0));
            return late_.push_back({begin, topology, object_, smoothing_, material_name_});
        }
        const std::size_t least = topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 0;
        if (corners_.size() < least) {
            if (builder_.options().strict)
                refuse(scanner_.where(), fmt::format("a {} has {} corners, expected at least {}",
                                                     topology == Topology::triangles ? "face" : "line", corners_.size(), least));
            return void(++short_faces_);
        }
        if (topology == Topology::triangles) return add_face();
        positions_.clear();
        for (const Corner& corner : corners_) positions_.push_back(corner.position);
        strokes_.add(current_part(), topology, positions_);
    }

    void add_face() {
        points_.clear();
        triangles_.clear();
        for (const Corner& corner : corners_) points_.push_back(soup_.positions[corner.position]);
        const std::uint32_t part = current_part();
        builder_.take_triangles(corners_.size() - 2);
        cutter_.cut(points_, triangles_);
        soup_.part_of.insert(soup_.part_of.end(), triangles_.size() / 3, part);
        soup_.smoothing_of.insert(soup_.smoothing_of.end(), triangles_.size() / 3, smoothing_);
        for (const std::uint32_t i : triangles_) {
            const Corner& corner = corners_[i];
            soup_.position_of.push_back(corner.position);
            soup_.uv_of.push_back(corner.uv);
            soup_.normal_of.push_back(corner.normal);
        }
    }

    /// A colour that is not there.
    static constexpr Vec4f kNoColor{0, 0, 0, -1};

    TextScanner scanner_;
    std::vector<std::string_view> painted_;
    ModelBuilder& builder_;
    MtlLibraries libraries_;
    ObjStrokes strokes_;
    Soup soup_;
    PolygonCutter cutter_;
    std::vector<std::string> objects_{""};
    std::vector<Part> parts_;
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> part_at_;
    std::optional<std::string> material_name_;
    bool material_is_known_ = true;
    int material_ = -1;
    std::uint32_t object_ = 0, part_ = kNone, smoothing_ = Soup::kByCrease;
    std::vector<Corner> corners_;
    std::vector<Vec3d> points_;
    std::vector<std::uint32_t> triangles_, positions_;
    std::vector<Late> late_;
    bool late_are_read_ = false;
    std::size_t free_form_ = 0, bad_faces_ = 0, short_faces_ = 0, lost_attributes_ = 0;
};

}  // namespace

LoadedScene read_obj(const ModelFile& file, const LoadOptions& options) {
    ModelBuilder builder(file.bytes, file.folder, options, "OBJ");
    ObjReader reader(file, builder);
    reader.read();
    reader.finish();
    return builder.finish({});
}

std::vector<std::string> files_of_obj(const ModelFile& file, const LoadOptions& options) {
    ModelBuilder builder(file.bytes, file.folder, options, "OBJ");
    ObjReader(file, builder).add_files();
    return builder.finish({}).info.files;
}

}  // namespace halflit::io::detail
