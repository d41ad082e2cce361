// PLY: vertices and polygons, as text or binary of either byte order.
#include "apps/io/files/file_access.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_colors.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/ply_values.hpp"
#include "apps/io/models/polygon.hpp"
#include "apps/io/models/splat_reader.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>

namespace halflit::io::detail {

namespace {

/// Places where values of a vertex or a face go.
enum Slot : std::uint8_t {
    px,
    py,
    pz,
    nx,
    ny,
    nz,
    tu,
    tv,
    red,
    green,
    blue,
    packed,
    harmonic_0,
    harmonic_1,
    harmonic_2,
    opacity,
    scalar,
    label,
    indices,
    texcoord,
    texnumber,
    kSlots
};  // clang-format: off

struct SlotName {
    std::string_view name;
    Slot slot;
};
constexpr SlotName kScalarNames[] = {{"x", px},
                                     {"y", py},
                                     {"z", pz},
                                     {"nx", nx},
                                     {"ny", ny},
                                     {"nz", nz},
                                     {"s", tu},
                                     {"t", tv},
                                     {"u", tu},
                                     {"v", tv},
                                     {"texture_u", tu},
                                     {"texture_v", tv},
                                     {"r", red},
                                     {"g", green},
                                     {"b", blue},
                                     {"red", red},
                                     {"green", green},
                                     {"blue", blue},
                                     {"diffuse_red", red},
                                     {"diffuse_green", green},
                                     {"diffuse_blue", blue},
                                     {"rgb", packed},
                                     {"rgba", packed},
                                     {"f_dc_0", harmonic_0},
                                     {"f_dc_1", harmonic_1},
                                     {"f_dc_2", harmonic_2},
                                     {"opacity", opacity},
                                     {"intensity", scalar},
                                     {"reflectance", scalar},
                                     {"quality", scalar},
                                     {"confidence", scalar},
                                     {"curvature", scalar},
                                     {"texnumber", texnumber},
                                     {"texture_id", texnumber},
                                     {"tex_id", texnumber},
                                     {"texture_index", texnumber},
                                     {"texture_number", texnumber},
                                     {"label", label},
                                     {"labels", label},
                                     {"class", label},
                                     {"classification", label},
                                     {"category", label},
                                     {"class_id", label},
                                     {"semantic", label},
                                     {"segment", label},
                                     {"instance", label},
                                     {"object_id", label}};
constexpr SlotName kListNames[] = {{"vertex_indices", indices}, {"vertex_index", indices}, {"texcoord", texcoord}};

Slot slot_of(std::string_view name, bool is_list) {
    for (const SlotName& known : is_list ? std::span<const SlotName>(kListNames) : std::span<const SlotName>(kScalarNames))
        if (same_word(name, known.name)) return known.slot;
    return !is_list && name.starts_with("scalar_") ? scalar : kSlots;  // as CloudCompare writes them
}

/// Properties of an element, by their slots.
struct Layout {
    std::vector<Slot> slots;                 ///< of each property; kSlots: not used
    std::array<bool, kSlots + 1> has{};      ///< by slot
    std::array<PlyType, kSlots + 1> type{};  ///< by slot
    std::string_view scalar_name;

    explicit Layout(const PlyElement& element) {
        for (const PlyProperty& p : element.properties) {
            const Slot slot = slot_of(p.name, p.is_list);
            slots.push_back(has[slot] ? kSlots : slot);
            if (has[slot]) continue;
            has[slot] = true;
            type[slot] = p.type;
            if (slot == scalar) scalar_name = p.name;
        }
        if (has[indices]) return;
        // The list of corners under another name: the first list of whole numbers.
        for (std::size_t p = 0; p < slots.size(); ++p) {
            const PlyProperty& list = element.properties[p];
            if (!list.is_list || !is_whole(list.type) || slots[p] != kSlots) continue;
            slots[p] = indices;
            has[indices] = true;
            return;
        }
    }
    [[nodiscard]] bool has_channels() const { return has[red] && has[green] && has[blue]; }
    /// True for 3D Gaussians, whose colour is the part of their light that is the same from all sides.
    [[nodiscard]] bool is_splat() const { return has[harmonic_0] && has[harmonic_1] && has[harmonic_2] && has[opacity]; }
    [[nodiscard]] bool has_color() const { return has_channels() || has[packed] || is_splat() || has_label(); }
    /// Classes or objects by number, where nothing else has colours.
    [[nodiscard]] bool has_label() const { return has[label] && !has_channels() && !has[packed] && !is_splat(); }
    /// In the unit of the file; alpha is a share.
    [[nodiscard]] Vec4f color(const std::array<double, kSlots + 1>& value) const {
        const auto of = [&](Slot slot) { return static_cast<float>(value[slot]); };
        if (has_channels()) return {of(red), of(green), of(blue), 1};
        if (has_label()) return label_color(value[label]);
        if (has[packed]) {  // 0xRRGGBB, which the Point Cloud Library keeps as the bits of a float
            const bool is_float = type[packed] == PlyType::f32 || type[packed] == PlyType::f64;
            const auto whole = static_cast<std::uint32_t>(static_cast<std::int64_t>(
                !is_float && value[packed] >= -2147483648.0 && value[packed] <= 4294967295.0 ? value[packed] : 0.0));
            const std::uint32_t bits = is_float ? std::bit_cast<std::uint32_t>(of(packed)) : whole;
            return {static_cast<float>(bits >> 16 & 255u), static_cast<float>(bits >> 8 & 255u), static_cast<float>(bits & 255u), 1};
        }
        const auto share = [&](Slot slot) { return static_cast<float>(std::clamp(0.5 + kFirstHarmonic * value[slot], 0.0, 1.0)); };
        return {share(harmonic_0), share(harmonic_1), share(harmonic_2), static_cast<float>(opacity_of_logit(value[opacity]))};
    }
    /// Makes linear light of colours as color() gives them.
    void make_linear(std::span<Vec4f> colors, Document& document) const {
        if (has_label()) return;
        const bool are_whole = has_channels() ? is_whole(type[red]) : has[packed];
        if (has_channels() && type[red] == PlyType::u8) return detail::make_linear(colors, 255);
        make_linear_by_range(colors, are_whole, document);
    }
};

class PlyReader {
public:
    PlyReader(std::span<const std::byte> bytes, ModelBuilder& builder)
        : header_(read_ply_header(bytes, builder.document())), values_(header_, builder.document()), builder_(builder) {}

    void add_files() {
        for (const std::string_view name : header_.textures) builder_.add_file(name);
    }

    /// The 3D Gaussians that the file is made of; nothing: it has none, or lacks their sizes and shapes.
    [[nodiscard]] std::optional<SplatCloud> splats() { return read_ply_splats(header_, builder_.document()); }

    void read() {
        add_files();
        name_elements();
        values_.mend_counts(header_.elements, builder_.document());
        const auto find = [&](const auto& is) { return std::find_if(header_.elements.begin(), header_.elements.end(), is); };
        const auto vertices = find([](const PlyElement& e) { return e.name == kVertex && e.count > 0; });
        const auto corners = find([](const PlyElement& e) { return (e.name == kFace || e.name == kStrips) && e.count > 0; });
        is_cloud_ = vertices != header_.elements.end() && corners == header_.elements.end();
        // Faces may come before their vertices. Then these are read first.
        if (vertices != header_.elements.end()) {
            const PlyValues all = values_;
            try {
                for (auto element = header_.elements.begin(); element != vertices; ++element) skip(*element);
                read_vertices(*vertices);
            } catch (const CutOff&) {
                note_cut_off(*vertices, soup_.positions.size());
            }
            if (corners < vertices) values_ = all;
        }
        for (auto element = corners < vertices || vertices == header_.elements.end() ? header_.elements.begin() : vertices + 1;
             element != header_.elements.end() && !(cut_off_ && element >= vertices); ++element) {
            try {
                if (element == vertices)
                    skip(*element);
                else
                    read_others(*element);
            } catch (const CutOff&) {
                note_cut_off(*element, rows_);
                break;
            }
        }
        is_cloud_ = is_cloud_ || (cut_off_ && soup_.position_of.empty() && !soup_.positions.empty());
        Document& document = builder_.document();
        values_.warn();
        if (values_.has_more()) document.warn("there is more behind the last element, which is not drawn");
        if (short_polygons_ > 0) document.warn(fmt::format("{} polygons of less than three corners left out", short_polygons_));
        if (bad_texcoords_ > 0)
            document.warn(fmt::format("{} polygons have a list texcoord of another length than twice their corners, and are drawn without",
                                      bad_texcoords_));
        if (bad_indices_ > 0) document.warn(fmt::format("{} polygons with indices out of range left out", bad_indices_));
    }

    void finish() {
        if (is_cloud_) {
            finish_cloud();
            return;
        }
        std::vector<int> materials;
        const bool is_textured = !header_.textures.empty() && (vertex_has_uv_ || !soup_.uv_of.empty());
        if (is_textured) {
            soup_.colors.clear();  // a picture has the colours already
            soup_.color_of.clear();
            for (const std::string_view name : header_.textures) {
                Material material;
                material.name = printable(name, 80);
                material.metallic = 0.0f;
                material.roughness = 0.6f;
                material.double_sided = true;
                material.textures[TextureSlot::base_color].texture =
                    builder_.texture(name, fmt::format("TextureFile {}", printable(name, 80)), ColorSpace::srgb);
                materials.push_back(builder_.add_material(material));
            }
        } else {
            soup_.part_of.clear();
            materials.push_back(soup_.color_of.empty() ? builder_.grey_material() : builder_.colored_material());
        }
        builder_.place_alone(std::move(soup_), materials);
    }

    /// PLY has y up by custom. Surveys of the ground have z: clouds in double that are much flatter along
    /// z than along x and y.
    [[nodiscard]] UpAxis up() const { return lies_flat_ ? UpAxis::z : UpAxis::y; }

private:
    using Row = std::array<double, kSlots + 1>;
    static constexpr std::string_view kVertex = "vertex", kFace = "face", kStrips = "tristrips";

    /// Elements under other names: points are what has x, y and z, faces what has a list of whole numbers.
    void name_elements() {
        const auto is_named = [&](std::string_view name) {
            return std::any_of(header_.elements.begin(), header_.elements.end(), [&](const PlyElement& e) { return e.name == name; });
        };
        const bool has_vertices = is_named(kVertex), has_faces = is_named(kFace) || is_named(kStrips);
        for (PlyElement& element : header_.elements) {
            const Layout layout(element);
            if (!has_vertices && layout.has[px] && layout.has[py] && layout.has[pz] && !is_named(kVertex))
                element.name = kVertex;
            else if (!has_faces && layout.has[indices] && element.name != kVertex && !is_named(kFace))
                element.name = kFace;
        }
    }

    /// Says that an element is not there to its end.
    void note_cut_off(const PlyElement& element, std::size_t there) {
        cut_off_ = true;
        builder_.document().go_on_without({{ErrorCode::bad_input, fmt::format("it was cut off: {} of {} elements \"{}\" are there", there,
                                                                              element.count, printable(element.name, 40))}},
                                          "the rest is left out");
    }

    /// Colours of points that have a number instead.
    void color_by_scalar(std::string_view name) {
        float least = std::numeric_limits<float>::infinity(), most = -least;
        for (const float value : scalars_)
            if (shading::finite(value)) least = std::min(least, value), most = std::max(most, value);
        if (!(least < most)) return;
        builder_.take_entries<Vec4f>(scalars_.size());
        const double range = static_cast<double>(most) - static_cast<double>(least);
        for (const float value : scalars_)
            soup_.colors.push_back(
                viridis(shading::finite(value) ? (static_cast<double>(value) - static_cast<double>(least)) / range : 0.0));
        builder_.document().warn(
            fmt::format("has no colours: drawn by its property {}, from {} (dark blue) to {} (yellow)", printable(name, 40), least, most));
    }

    /// Surveys have z up: clouds that are flat, and those that lie as far from the origin along x or y as maps do, but not along z. Strays
    /// do not count: of each axis, the middle nine tenths. Coordinates in double and labels are a survey's: then less flatness will do
    /// than elsewhere, where a relief may stand. What has no height at all stands too, as a drawing does.
    void note_flatness() {
        constexpr double kFlatSurvey = 0.35, kFlat = 0.2, kFar = 100.0, kHeight = 0.1;
        constexpr std::size_t kSampled = 4096;
        std::array<double, 3> extents{}, middle{};
        const std::size_t step = std::max<std::size_t>(1, soup_.positions.size() / kSampled);
        std::vector<double> at;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at.clear();
            for (std::size_t i = 0; i < soup_.positions.size(); i += step) {
                const Vec3d& p = soup_.positions[i];
                if (fits_float(p)) at.push_back(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
            }
            if (at.empty()) return;
            std::sort(at.begin(), at.end());
            extents[axis] = at[at.size() - 1 - at.size() / 20] - at[at.size() / 20];
            middle[axis] = std::abs(at[at.size() / 2]);
        }
        const double away = std::max(middle[0], middle[1]);
        const bool on_map = away > kFar * std::max({extents[0], extents[1], extents[2]}) && middle[2] < kHeight * away;
        lies_flat_ = on_map || (extents[2] > 0 && extents[2] < (is_survey_ ? kFlatSurvey : kFlat) * std::min(extents[0], extents[1]));
        if (lies_flat_ && !builder_.options().up)
            builder_.document().warn(on_map ? "a cloud that lies as on a map is drawn with z up"
                                            : "a cloud that is flat along z is drawn lying, with z up");
    }

    /// Vertices without faces are points.
    void finish_cloud() {
        note_flatness();
        if (is_splat_) {
            soup_.normals.clear();
            builder_.document().warn(
                "holds 3D Gaussians: drawn as points with their colours and opacities, without sizes, shapes and "
                "colours that change with the view");
        }
        builder_.place_points(std::move(soup_), is_splat_ ? AlphaMode::blend : AlphaMode::opaque);
    }

    /// Reads an element's values: scalars into `row`, known lists into lists_. Others are skipped.
    void read_row(const PlyElement& element, const Layout& layout, Row& row) {
        values_.begin_row();
        read_values(element, layout, row);
        values_.end_row();
    }
    void read_values(const PlyElement& element, const Layout& layout, Row& row) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            const Slot slot = layout.slots[p];
            if (!property.is_list) {
                if (slot == kSlots)
                    values_.skip(property.type);
                else
                    row[slot] = values_.next(property.type);
                continue;
            }
            std::vector<double>* list = slot == indices ? &polygon_ : slot == texcoord ? &texcoords_ : nullptr;
            std::size_t left = values_.next_length(property);
            if (list != nullptr) list->clear();
            for (; left > 0; --left) {
                if (list == nullptr)
                    values_.skip(property.type);
                else
                    list->push_back(values_.next(property.type));
            }
        }
    }

    void read_vertices(const PlyElement& element) {
        const Layout layout(element);
        if (!layout.has[px] || !layout.has[py] || !layout.has[pz]) refuse("element vertex", "expected the properties x, y and z");
        const bool has_normal = layout.has[nx] && layout.has[ny] && layout.has[nz], has_color = layout.has_color();
        vertex_has_uv_ = layout.has[tu] && layout.has[tv];
        if (element.count >= kNone)
            refuse("element vertex", fmt::format("{} vertices, the limit is {}", element.count, kNone), ErrorCode::limit);
        const std::uint64_t count = values_.held(element);
        const bool by_scalar = is_cloud_ && !has_color && layout.has[scalar];
        builder_.take_entries<Vec3d>(count);
        builder_.take_entries<Vec3f>(count * ((has_normal ? 1 : 0) + (vertex_has_uv_ ? 1 : 0) + (has_color ? 2 : 0) + (by_scalar ? 1 : 0)));
        vertex_has_normal_ = has_normal;
        is_survey_ = layout.type[px] == PlyType::f64 || layout.has[label];
        vertex_has_color_ = has_color;
        is_splat_ = is_cloud_ && layout.is_splat() && !layout.has_channels() && !layout.has[packed];
        Row row{};
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) check_time(), TakenBytes::before(values_.place());
            try {
                read_row(element, layout, row);
            } catch (const CutOff&) {
                note_cut_off(element, soup_.positions.size());
                break;
            }
            if (by_scalar) scalars_.push_back(static_cast<float>(row[scalar]));
            const auto vector = [&](Slot first) {
                return Vec3f{static_cast<float>(row[first]), static_cast<float>(row[first + 1]), static_cast<float>(row[first + 2])};
            };
            soup_.positions.push_back({row[px], row[py], row[pz]});
            if (has_normal) soup_.normals.push_back(vector(nx));
            if (vertex_has_uv_) soup_.uvs.push_back({static_cast<float>(row[tu]), static_cast<float>(1.0 - row[tv])});
            if (has_color) soup_.colors.push_back(layout.color(row));
        }
        if (has_color) layout.make_linear(soup_.colors, builder_.document());
        if (layout.has_label()) builder_.document().warn("has no colours: drawn by its labels, a colour for each");
        if (drop_no_colors(ModelFormat::ply, soup_, builder_.document())) vertex_has_color_ = false;
        if (by_scalar) color_by_scalar(layout.scalar_name);
    }

    /// Goes past an element, without looking at its values.
    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        const std::uint64_t count = values_.held(element);
        const Layout layout(element);
        Row row{};
        for (std::uint64_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) check_time();
            read_row(element, layout, row);
        }
    }

    void read_others(const PlyElement& element) {
        if (element.properties.empty()) return;
        const std::uint64_t count = values_.held(element);
        const Layout layout(element);
        const bool is_face = element.name == kFace, is_strips = element.name == kStrips;
        if ((is_face || is_strips) && !layout.has[indices])
            refuse(fmt::format("element {}", element.name), "expected a list vertex_indices");
        if (!is_face && !is_strips && element.count > 0)
            builder_.document().warn(fmt::format("{} elements \"{}\" are not drawn", element.count, printable(element.name, 40)));
        if (is_face && header_.textures.size() > 1 && !layout.has[texnumber])
            builder_.document().warn(
                fmt::format("has {} pictures, and its faces do not say which one they show: all show the first", header_.textures.size()));
        Row row{};
        const std::size_t first_color = soup_.colors.size();
        const auto finish_colors = [&] {
            layout.make_linear(std::span(soup_.colors).subspan(first_color), builder_.document());
            if (!vertex_has_color_) drop_no_colors(ModelFormat::ply, soup_, builder_.document());
        };
        try {
            for (rows_ = 0; rows_ < count; ++rows_) {
                if (rows_ % 65536 == 0) check_time(), TakenBytes::before(values_.place());
                read_row(element, layout, row);
                if (is_strips) add_strips();
                if (is_face) add_face(layout, row);
            }
        } catch (const CutOff&) {
            finish_colors();
            throw;
        }
        finish_colors();
    }

    void add_strips() {
        std::size_t first = 0;
        std::vector<double> strip = std::move(polygon_);
        for (std::size_t i = 0; i <= strip.size(); ++i) {
            if (i < strip.size() && strip[i] != -1) continue;
            for (std::size_t k = first; k + 2 < i; ++k) {
                const bool turned = (k - first) % 2 == 1;
                polygon_ = {strip[k], strip[turned ? k + 2 : k + 1], strip[turned ? k + 1 : k + 2]};
                add_polygon(kNone, 0, false);
            }
            first = i + 1;
        }
    }

    void add_face(const Layout& layout, const Row& row) {
        std::uint32_t color = kNone, part = 0;
        if (!vertex_has_color_ && layout.has_color()) {
            builder_.take_entries<Vec4f>(1);
            color = static_cast<std::uint32_t>(soup_.colors.size());
            soup_.colors.push_back(layout.color(row));
        }
        if (layout.has[texnumber] && row[texnumber] >= 0 && row[texnumber] < static_cast<double>(header_.textures.size()))
            part = static_cast<std::uint32_t>(row[texnumber]);
        add_polygon(color, part, layout.has[texcoord]);
    }

    /// Adds polygon_: its corners' numbers.
    void add_polygon(std::uint32_t face_color, std::uint32_t part, bool has_texcoords) {
        corners_.clear();
        for (const double index : polygon_) {
            if (!(index >= 0 && index < static_cast<double>(soup_.positions.size()))) {
                if (builder_.options().strict)
                    refuse(values_.where(), fmt::format("a face has the vertex {}, but there are {}", index, soup_.positions.size()));
                ++bad_indices_;
                return;
            }
            corners_.push_back(static_cast<std::uint32_t>(index));
        }
        if (corners_.size() < 3) return void(++short_polygons_);
        points_.clear();
        for (const std::uint32_t corner : corners_) points_.push_back(soup_.positions[corner]);
        triangles_.clear();
        builder_.take_triangles(corners_.size() - 2);
        cutter_.cut(points_, triangles_);

        const auto first_uv = static_cast<std::uint32_t>(soup_.uvs.size());
        const bool own_uvs = has_texcoords && !vertex_has_uv_ && texcoords_.size() == 2 * corners_.size();
        if (has_texcoords && !vertex_has_uv_ && !own_uvs) ++bad_texcoords_;
        if (own_uvs) {
            builder_.take_entries<Vec2f>(corners_.size());
            for (std::size_t i = 0; i < corners_.size(); ++i)
                soup_.uvs.push_back({static_cast<float>(texcoords_[2 * i]), static_cast<float>(1.0 - texcoords_[2 * i + 1])});
            soup_.uv_of.resize(soup_.position_of.size(), kNone);
        }
        if (header_.textures.size() > 1) soup_.part_of.insert(soup_.part_of.end(), triangles_.size() / 3, part);
        if (face_color != kNone) soup_.color_of.resize(soup_.position_of.size(), kNone);
        for (const std::uint32_t i : triangles_) {
            const std::uint32_t vertex = corners_[i];
            soup_.position_of.push_back(vertex);
            if (vertex_has_normal_) soup_.normal_of.push_back(vertex);
            if (vertex_has_uv_) soup_.uv_of.push_back(vertex);
            if (own_uvs) soup_.uv_of.push_back(first_uv + i);
            if (vertex_has_color_ || face_color != kNone) soup_.color_of.push_back(vertex_has_color_ ? vertex : face_color);
        }
    }

    PlyHeader header_;
    PlyValues values_;
    ModelBuilder& builder_;
    Soup soup_;
    PolygonCutter cutter_;
    bool vertex_has_normal_ = false, vertex_has_uv_ = false, vertex_has_color_ = false;
    std::vector<double> polygon_, texcoords_;
    std::vector<std::uint32_t> corners_, triangles_;
    std::vector<Vec3d> points_;
    std::size_t bad_indices_ = 0, short_polygons_ = 0, bad_texcoords_ = 0;
    std::vector<float> scalars_;  ///< of points without colours
    std::uint64_t rows_ = 0;      ///< of the element that is being read
    bool is_survey_ = false;      ///< coordinates in double, as surveys have them
    bool lies_flat_ = false;
    bool is_cloud_ = false, is_splat_ = false, cut_off_ = false;
};

}  // namespace

LoadedScene read_ply(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "PLY");
    PlyReader reader(bytes, builder);
    if (auto cloud = reader.splats()) return finish_splats(builder, *std::move(cloud));
    reader.read();
    reader.finish();
    return builder.finish({.up = reader.up()});
}

std::vector<std::string> files_of_ply(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "PLY");
    PlyReader(bytes, builder).add_files();
    return builder.finish({}).info.files;
}

}  // namespace halflit::io::detail
