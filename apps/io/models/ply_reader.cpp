// PLY: vertices and polygons, as text or binary of either byte order.
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"
#include "apps/io/models/ply_values.hpp"
#include "apps/io/models/polygon.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace halflit::io::detail {

namespace {

/// Places where values of a vertex or a face go.
enum Slot : std::uint8_t { px, py, pz, nx, ny, nz, tu, tv, red, green, blue, indices, texcoord, texnumber, kSlots };

Slot slot_of(std::string_view name, bool is_list) {
    struct Name {
        std::string_view name;
        Slot slot;
    };
    static constexpr Name kScalars[] = {{"x", px},
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
                                        {"texnumber", texnumber}};
    static constexpr Name kLists[] = {{"vertex_indices", indices}, {"vertex_index", indices}, {"texcoord", texcoord}};
    for (const Name& known : is_list ? std::span<const Name>(kLists) : std::span<const Name>(kScalars))
        if (known.name == name) return known.slot;
    return kSlots;
}

/// Properties of an element, by their slots.
struct Layout {
    std::vector<Slot> slots;             ///< of each property; kSlots: not used
    std::array<bool, kSlots + 1> has{};  ///< by slot
    std::array<double, 3> color_unit{};  ///< of red, green and blue: what stands for 1

    explicit Layout(const PlyElement& element) {
        for (const PlyProperty& p : element.properties) {
            const Slot slot = slot_of(p.name, p.is_list);
            slots.push_back(has[slot] ? kSlots : slot);
            if (!has[slot] && slot >= red && slot <= blue)
                color_unit[slot - red] = p.type == PlyType::u8 ? 255 : p.type == PlyType::u16 ? 65535 : 1;
            has[slot] = true;
        }
    }
    [[nodiscard]] bool has_color() const { return has[red] && has[green] && has[blue]; }
    [[nodiscard]] Vec4f color(const std::array<double, kSlots + 1>& value) const {
        const auto channel = [&](Slot slot) { return linear_color(value[slot] / color_unit[slot - red]); };
        return {channel(red), channel(green), channel(blue), 1};
    }
};

class PlyReader {
public:
    PlyReader(std::span<const std::byte> bytes, ModelBuilder& builder)
        : header_(read_ply_header(bytes)), values_(header_), builder_(builder) {}

    void read() {
        const auto named = [](std::string_view name) { return [name](const PlyElement& e) { return e.name == name && e.count > 0; }; };
        const auto has = [&](std::string_view name) { return std::any_of(header_.elements.begin(), header_.elements.end(), named(name)); };
        is_cloud_ = has("vertex") && !has("face") && !has("tristrips");
        // Faces may come before their vertices. Then these are read first.
        const auto vertices = std::find_if(header_.elements.begin(), header_.elements.end(), named("vertex"));
        const auto corners = std::find_if(header_.elements.begin(), header_.elements.end(),
                                          [](const PlyElement& e) { return e.name == "face" || e.name == "tristrips"; });
        if (vertices != header_.elements.end()) {
            const PlyValues all = values_;
            for (auto element = header_.elements.begin(); element != vertices; ++element) skip(*element);
            values_.check_count(*vertices);
            read_vertices(*vertices);
            if (corners < vertices) values_ = all;
        }
        for (auto element = corners < vertices || vertices == header_.elements.end() ? header_.elements.begin() : vertices + 1;
             element != header_.elements.end(); ++element) {
            if (element == vertices)
                skip(*element);
            else
                read_others(*element);
        }
        Document& document = builder_.document();
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

private:
    using Row = std::array<double, kSlots + 1>;

    /// Vertices without faces are points. Those without normals are not lit.
    void finish_cloud() {
        Mesh mesh;
        mesh.topology = Topology::points;
        builder_.take_entries<std::uint32_t>(soup_.positions.size());
        std::size_t kept = 0;
        for (std::size_t i = 0; i < soup_.positions.size(); ++i) {
            if (!fits_float(soup_.positions[i])) continue;
            soup_.positions[kept] = soup_.positions[i];
            if (!soup_.normals.empty()) soup_.normals[kept] = soup_.normals[i];
            if (!soup_.colors.empty()) soup_.colors[kept] = soup_.colors[i];
            ++kept;
        }
        if (const std::size_t lost = soup_.positions.size() - kept; lost > 0)
            builder_.document().warn(fmt::format("{} points with coordinates that are not finite are left out", lost));
        soup_.positions.resize(kept);
        if (!soup_.normals.empty()) soup_.normals.resize(kept);
        if (!soup_.colors.empty()) soup_.colors.resize(kept);
        if (kept == 0) return;
        soup_.position_of.resize(kept);
        std::iota(soup_.position_of.begin(), soup_.position_of.end(), 0u);
        const Vec3d origin = move_near(soup_, builder_.options().recentre);
        mesh.positions = std::move(soup_.points);
        mesh.normals = std::move(soup_.normals);
        mesh.colors = std::move(soup_.colors);
        mesh.indices = std::move(soup_.position_of);
        mesh.material = mesh.colors.empty() ? builder_.grey_material() : builder_.colored_material();
        if (mesh.normals.empty()) builder_.loaded().scene.materials[static_cast<std::size_t>(mesh.material)].unlit = true;
        const int index = builder_.add_mesh(std::move(mesh), origin);
        builder_.place({&index, 1}, "");
    }

    /// Reads an element's values: scalars into `row`, known lists into lists_. Others are skipped.
    void read_row(const PlyElement& element, const Layout& layout, Row& row) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            const Slot slot = layout.slots[p];
            if (!property.is_list) {
                row[slot] = values_.next(property.type);
                continue;
            }
            std::vector<double>* list = slot == indices ? &polygon_ : slot == texcoord ? &texcoords_ : nullptr;
            std::size_t left = values_.next_length(property);
            if (list != nullptr) list->clear();
            for (; left > 0; --left) {
                const double value = values_.next(property.type);
                if (list != nullptr) list->push_back(value);
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
        builder_.take_entries<Vec3d>(element.count);
        builder_.take_entries<Vec3f>(element.count * ((has_normal ? 1 : 0) + (vertex_has_uv_ ? 1 : 0) + (has_color ? 2 : 0)));
        Row row{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (i % 65536 == 0) check_time();
            read_row(element, layout, row);
            const auto vector = [&](Slot first) {
                return Vec3f{static_cast<float>(row[first]), static_cast<float>(row[first + 1]), static_cast<float>(row[first + 2])};
            };
            soup_.positions.push_back({row[px], row[py], row[pz]});
            if (has_normal) soup_.normals.push_back(vector(nx));
            if (vertex_has_uv_) soup_.uvs.push_back({static_cast<float>(row[tu]), static_cast<float>(1.0 - row[tv])});
            if (has_color) soup_.colors.push_back(layout.color(row));
        }
        vertex_has_normal_ = has_normal;
        vertex_has_color_ = has_color;
    }

    /// Goes past an element, without looking at its values.
    void skip(const PlyElement& element) {
        if (element.properties.empty()) return;
        values_.check_count(element);
        const Layout layout(element);
        Row row{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (i % 65536 == 0) check_time();
            read_row(element, layout, row);
        }
    }

    void read_others(const PlyElement& element) {
        if (element.properties.empty()) return;
        values_.check_count(element);
        const Layout layout(element);
        const bool is_face = element.name == "face", is_strips = element.name == "tristrips";
        if ((is_face || is_strips) && !layout.has[indices])
            refuse(fmt::format("element {}", element.name), "expected a list vertex_indices");
        if (!is_face && !is_strips && element.count > 0)
            builder_.document().warn(fmt::format("{} elements \"{}\" are not drawn", element.count, printable(element.name, 40)));
        Row row{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (i % 65536 == 0) check_time();
            read_row(element, layout, row);
            if (is_strips) add_strips();
            if (is_face) add_face(layout, row);
        }
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
                if (!builder_.options().lenient)
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
    bool is_cloud_ = false;
};

}  // namespace

LoadedScene read_ply(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "PLY");
    PlyReader reader(bytes, builder);
    reader.read();
    reader.finish();
    return builder.finish({});
}

std::vector<std::string> files_of_ply(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "PLY");
    for (const std::string_view name : read_ply_header(bytes).textures) builder.add_file(name);
    return builder.finish({}).info.files;
}

}  // namespace halflit::io::detail
