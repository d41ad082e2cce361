// Files of 3D Gaussians: PLY as training programs write it and as SuperSplat compresses it, SPLAT, and SPZ.
#include "apps/io/models/splat_reader.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/codecs/spz.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/ply_values.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace halflit::io::detail {
namespace {

const PlyElement* element_named(const PlyHeader& header, std::string_view name) {
    const auto found = std::find_if(header.elements.begin(), header.elements.end(), [&](const PlyElement& e) { return e.name == name; });
    return found == header.elements.end() ? nullptr : &*found;
}

/// Place of a property among an element's; -1: it has none.
int property(const PlyElement& element, std::string_view name) {
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (element.properties[i].name == name && !element.properties[i].is_list) return static_cast<int>(i);
    return -1;
}

/// Rows of an element's numbers, in order.
class PlyRows {
public:
    PlyRows(const PlyHeader& header, Document& document) : values_(header, document) {}
    /// False: the file ends before.
    bool next(const PlyElement& element, std::vector<double>& row) {
        row.clear();
        try {
            values_.begin_row();
            for (const PlyProperty& p : element.properties) {
                if (!p.is_list) {
                    row.push_back(values_.next(p.type));
                    continue;
                }
                row.push_back(0.0);
                for (std::size_t left = values_.next_length(p); left > 0; --left) values_.skip(p.type);
            }
            values_.end_row();
        } catch (const CutOff&) {
            return false;
        }
        return true;
    }
    /// PlyValues::place()
    [[nodiscard]] const char* place() const { return values_.place(); }
    [[nodiscard]] std::uint64_t held(const PlyElement& element) const { return values_.held(element); }

private:
    PlyValues values_;
};

void warn_cut_off(Document& document, std::size_t there, std::uint64_t count) {
    document.go_on_without({{ErrorCode::bad_input, fmt::format("it was cut off: {} of {} Gaussians are there", there, count)}},
                           "the rest is left out");
}

SplatCloud read_trained(const PlyHeader& header, const PlyElement& vertex, Document& document) {
    std::vector<int> rest;
    for (int at = 0; (at = property(vertex, fmt::format("f_rest_{}", rest.size()))) >= 0;) rest.push_back(at);
    const auto of = [&](std::string_view name) { return static_cast<std::size_t>(property(vertex, name)); };
    const std::size_t x = of("x"), y = of("y"), z = of("z"), opacity = of("opacity");
    const std::array<std::size_t, 3> color{of("f_dc_0"), of("f_dc_1"), of("f_dc_2")}, scale{of("scale_0"), of("scale_1"), of("scale_2")};
    const std::array<std::size_t, 4> rotation{of("rot_1"), of("rot_2"), of("rot_3"), of("rot_0")};
    const bool is_flat = property(vertex, "scale_2") < 0;
    const int degree = degree_of(rest.size() / 3);
    const std::size_t per_channel = rest.size() / 3, used = rest_of_degree(degree);
    SplatCloud cloud;
    PlyRows rows(header, document);
    const std::uint64_t count = rows.held(vertex);
    cloud.reserve(document, count, degree);
    cloud.axes = kRightDownFront;
    cloud.set_reference(is_flat ? "2dgs" : header.trained_as, document);
    std::vector<double> row;
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty()) continue;
        for (std::uint64_t i = 0; i < (&element == &vertex ? count : element.count); ++i) {
            if (i % 4096 == 0) check_time(), TakenBytes::before(rows.place());
            if (!rows.next(element, row)) {
                warn_cut_off(document, cloud.positions.size(), vertex.count);
                return cloud;
            }
            if (&element != &vertex) continue;
            const auto size = [&](std::size_t axis) { return axis == 2 && is_flat ? 0.0 : scale_of_log(row[scale[axis]]); };
            cloud.add({row[x], row[y], row[z]}, {row[rotation[0]], row[rotation[1]], row[rotation[2]], row[rotation[3]]},
                      {size(0), size(1), size(2)}, opacity_of_logit(row[opacity]));
            for (const std::size_t c : color) cloud.add_color(row[c]);
            for (std::size_t k = 0; k < used; ++k)
                for (std::size_t c = 0; c < 3; ++c) cloud.add_color(row[static_cast<std::size_t>(rest[c * per_channel + k])]);
        }
        if (&element == &vertex) break;
    }
    return cloud;
}

SplatCloud read_compressed(const PlyHeader& header, const PlyElement& vertex, const PlyElement& chunk, Document& document) {
    constexpr std::uint64_t kChunk = 256;
    const auto required = [&](const PlyElement& element, std::string_view name) {
        const int at = property(element, name);
        if (at < 0) refuse(fmt::format("element {}", element.name), fmt::format("expected the property {}", name));
        return static_cast<std::size_t>(at);
    };
    const std::array<std::size_t, 4> packed{required(vertex, "packed_position"), required(vertex, "packed_rotation"),
                                            required(vertex, "packed_scale"), required(vertex, "packed_color")};
    std::array<std::size_t, 12> ends{};
    constexpr std::string_view kEnds[] = {"min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
                                          "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"};
    for (std::size_t i = 0; i < 12; ++i) ends[i] = required(chunk, kEnds[i]);
    std::array<int, 6> colors{};
    constexpr std::string_view kColorEnds[] = {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"};
    for (std::size_t i = 0; i < 6; ++i) colors[i] = property(chunk, kColorEnds[i]);
    const PlyElement* const sh = element_named(header, "sh");
    const std::size_t rest = sh != nullptr ? sh->properties.size() : 0, per_channel = rest / 3;
    const int degree = degree_of(rest / 3);
    const std::size_t used = rest_of_degree(degree), coefficients = 3 * (used + 1);

    SplatCloud cloud;
    PlyRows rows(header, document);
    const std::uint64_t count = rows.held(vertex);
    cloud.reserve(document, count, degree);
    cloud.axes = kRightDownFront;
    cloud.set_reference(header.trained_as, document);
    document.geometry.take(std::min<std::uint64_t>(chunk.count, header.body.size()) *
                           (sizeof(double) * chunk.properties.size() + 2 * sizeof(std::vector<double>)));
    std::vector<std::vector<double>> chunks;
    std::vector<double> row;
    std::uint64_t with_rest = 0;
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty()) continue;
        const bool is_chunk = &element == &chunk, is_vertex = &element == &vertex, is_rest = &element == sh;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (i % 4096 == 0) check_time();
            if (!rows.next(element, row)) {
                warn_cut_off(document, cloud.positions.size(), vertex.count);
                return cloud;
            }
            if (is_chunk) chunks.push_back(row);
            if (is_rest && with_rest < cloud.positions.size()) {
                float* const to = cloud.splats.harmonics.data() + coefficients * with_rest++ + 3;
                for (std::size_t k = 0; k < used; ++k)
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double b = row[c * per_channel + k];
                        const double share = b <= 0.0 ? 0.0 : b >= 255.0 ? 1.0 : (b + 0.5) / 256.0;
                        to[3 * k + c] = static_cast<float>((share - 0.5) * 8.0);
                    }
            }
            if (!is_vertex) continue;
            if (i / kChunk >= chunks.size()) refuse("element vertex", "a Gaussian has no chunk");
            const std::vector<double>& box = chunks[i / kChunk];
            std::array<std::uint32_t, 4> bits{};
            for (std::size_t k = 0; k < 4; ++k) {
                const double value = row[packed[k]];
                bits[k] = value >= 0.0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0u;
            }
            const auto place = [&](std::uint32_t p, std::size_t first) {
                return std::array<double, 3>{between(box[ends[first]], box[ends[first + 3]], p >> 21 & 2047u, 2047),
                                             between(box[ends[first + 1]], box[ends[first + 4]], p >> 11 & 1023u, 1023),
                                             between(box[ends[first + 2]], box[ends[first + 5]], p & 2047u, 2047)};
            };
            const std::array<double, 3> position = place(bits[0], 0), log_scale = place(bits[2], 6);
            const auto part = [&](std::uint32_t shift) {
                return between(-0.70710678118654752, 0.70710678118654752, bits[1] >> shift & 1023u, 1023);
            };
            cloud.add(position, rotation_of({part(20), part(10), part(0)}, bits[1] >> 30, true),
                      {scale_of_log(log_scale[0]), scale_of_log(log_scale[1]), scale_of_log(log_scale[2])}, (bits[3] & 255u) / 255.0);
            for (std::uint32_t c = 0; c < 3; ++c) {
                const std::uint32_t code = bits[3] >> (24 - 8 * c) & 255u;
                const bool ranged = colors[c] >= 0 && colors[c + 3] >= 0;
                cloud.add_color(harmonic_of(
                    ranged ? between(box[static_cast<std::size_t>(colors[c])], box[static_cast<std::size_t>(colors[c + 3])], code, 255)
                           : code / 255.0));
            }
            cloud.splats.harmonics.resize(cloud.splats.harmonics.size() + 3 * used, 0.0f);
        }
    }
    return cloud;
}

}  // namespace

LoadedScene finish_splats(ModelBuilder& builder, SplatCloud&& cloud) {
    // A host that says which axis is up gets the coordinates of the file.
    const std::uint32_t bits = (builder.options().up ? kRightUpBack : cloud.axes) - 1;
    const double right = (bits & 1u) != 0 ? 1 : -1, up = (bits & 2u) != 0 ? 1 : -1,
                 back = ((bits & 4u) != 0) == ((bits & 8u) != 0) ? 1 : -1;
    Affine turn{{{right, 0, 0}, {0, up, 0}, {0, 0, back}, {}}};
    if ((bits & 8u) != 0) std::swap(turn.c[1], turn.c[2]);
    Mesh mesh = splat_mesh(std::move(cloud), builder.document());
    if (!mesh.splats->opacities.empty()) {
        mesh.material = builder.colored_material();
        builder.loaded().scene.materials[static_cast<std::size_t>(mesh.material)].unlit = true;
        const int index = builder.add_mesh(std::move(mesh), {});
        builder.place({&index, 1}, "", turn);
    }
    return builder.finish({});
}

std::optional<SplatCloud> read_ply_splats(const PlyHeader& header, Document& document) {
    const PlyElement* const vertex = element_named(header, "vertex");
    if (vertex == nullptr || vertex->count == 0) return std::nullopt;
    if (const PlyElement* const chunk = element_named(header, "chunk"); chunk != nullptr && property(*vertex, "packed_position") >= 0)
        return read_compressed(header, *vertex, *chunk, document);
    for (const std::string_view name :
         {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "rot_0", "rot_1", "rot_2", "rot_3"})
        if (property(*vertex, name) < 0) return std::nullopt;
    return read_trained(header, *vertex, document);
}

std::optional<LoadedScene> read_splat_file(const ModelFile& file, const LoadOptions& options) {
    constexpr std::size_t kBytes = 32;
    const std::size_t count = file.bytes.size() / kBytes;
    if (count == 0 || begins_as_text(file.bytes)) return std::nullopt;
    ModelBuilder builder(file.bytes, file.folder, options, "SPLAT");
    if (file.bytes.size() % kBytes != 0) warn_cut_off(builder.document(), count, count + 1);
    SplatCloud cloud;
    cloud.reserve(builder.document(), count, 0);
    cloud.axes = kRightDownFront;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0) check_time();
        const auto number = [&](std::size_t k) { return std::bit_cast<float>(u32_at(file.bytes, kBytes * i + 4 * k)); };
        const auto code = [&](std::size_t k) { return byte_at(file.bytes, kBytes * i + 24 + k); };
        const auto turn = [&](std::size_t k) { return (code(k) - 128.0) / 128.0; };
        cloud.add({number(0), number(1), number(2)}, {turn(5), turn(6), turn(7), turn(4)}, {number(3), number(4), number(5)},
                  code(3) / 255.0);
        for (std::size_t c = 0; c < 3; ++c) cloud.add_color(harmonic_of(code(c) / 255.0));
    }
    return finish_splats(builder, std::move(cloud));
}

std::optional<LoadedScene> read_spz_file(const ModelFile& file, const LoadOptions& options) {
    ModelBuilder builder(file.bytes, file.folder, options, "SPZ");
    auto cloud = read_spz(file.bytes, builder.document());
    if (!cloud) return std::nullopt;
    return finish_splats(builder, *std::move(cloud));
}

}  // namespace halflit::io::detail
