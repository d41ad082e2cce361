// Polyhedra, and files of them in each format that load_model reads.
#pragma once

#include "halflit/math.hpp"
#include "halflit/model.hpp"

#include "tests/io/gltf_builder.hpp"
#include "tests/support/catch.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::test {

/// Polygons of points; counter-clockwise as seen from outside. triangles: the same surface, cut by hand.
struct Polyhedron {
    std::vector<Vec3f> points;
    std::vector<std::vector<unsigned>> polygons;
    std::vector<std::array<unsigned, 3>> triangles;
};

/// A prism over the letter L, whose caps are concave; all edges are right angles.
inline Polyhedron letter() {
    Polyhedron p;
    const Vec2f outline[] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};
    for (const float z : {0.0f, 1.5f})
        for (const Vec2f& o : outline) p.points.push_back({o.x, o.y, z});
    p.polygons = {{6, 7, 8, 9, 10, 11}, {5, 4, 3, 2, 1, 0}};
    p.triangles = {{6, 7, 8}, {6, 8, 9}, {6, 9, 11}, {9, 10, 11}, {0, 2, 1}, {0, 3, 2}, {0, 5, 3}, {3, 5, 4}};
    for (unsigned i = 0; i < 6; ++i) {
        const unsigned j = (i + 1) % 6;
        p.polygons.push_back({i, j, j + 6, i + 6});
        p.triangles.push_back({i, j, j + 6});
        p.triangles.push_back({i, j + 6, i + 6});
    }
    return p;
}

/// The shortest text that std::from_chars reads as the same float.
inline std::string text_of(float value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}
inline std::string text_of(Vec3f p) { return text_of(p.x) + " " + text_of(p.y) + " " + text_of(p.z); }

/// Where z points up: the loader turns y to z's place.
inline Vec3f z_up(Vec3f p) { return {p.x, -p.z, p.y}; }

inline void append_bytes(Bytes& out, std::string_view text) {
    const Bytes bytes = to_bytes(text);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

inline Bytes gltf_of(const Polyhedron& p) {
    TriangleFile file;
    file.bin.clear();
    for (const auto& t : p.triangles)
        for (const unsigned i : t) append<float>(file.bin, {p.points[i].x, p.points[i].y, p.points[i].z});
    file.views = R"({"buffer":0,"byteLength":)" + std::to_string(file.bin.size()) + "}";
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":)" + std::to_string(3 * p.triangles.size()) + R"(,"type":"VEC3"})";
    return file.file();
}

inline Bytes stl_text_of(const Polyhedron& p) {
    std::string text = "solid letter\n";
    for (const auto& t : p.triangles) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const unsigned i : t) text += "  vertex " + text_of(z_up(p.points[i])) + "\n";
        text += " endloop\nendfacet\n";
    }
    return to_bytes(text + "endsolid letter\n");
}

/// attribute: of each triangle.
inline Bytes stl_binary_of(const Polyhedron& p, std::string title, const std::vector<std::uint16_t>& attributes = {}) {
    title.resize(80, ' ');
    Bytes out = to_bytes(title);
    append_u32(out, static_cast<std::uint32_t>(p.triangles.size()));
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
        append<float>(out, {0, 0, 0});
        for (const unsigned i : p.triangles[t]) {
            const Vec3f v = z_up(p.points[i]);
            append<float>(out, {v.x, v.y, v.z});
        }
        append<std::uint16_t>(out, {t < attributes.size() ? attributes[t] : std::uint16_t{0}});
    }
    return out;
}

enum class PlyKind { text, little, big };

inline Bytes ply_of(const Polyhedron& p, PlyKind kind) {
    const char* const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string header = std::string("ply\nformat ") + names[static_cast<int>(kind)] + " 1.0\ncomment made by a test\nelement vertex " +
                         std::to_string(p.points.size()) +
                         "\nproperty float x\nproperty float y\nproperty double z\nproperty uchar ignored\nelement face " +
                         std::to_string(p.polygons.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    Bytes out = to_bytes(header);
    const auto put = [&](auto value) {
        Bytes bytes;
        append(bytes, {value});
        if (kind == PlyKind::big) std::reverse(bytes.begin(), bytes.end());
        out.insert(out.end(), bytes.begin(), bytes.end());
    };
    for (const Vec3f& v : p.points) {
        if (kind == PlyKind::text) {
            append_bytes(out, text_of(v) + " 7\n");
        } else {
            put(v.x), put(v.y), put(static_cast<double>(v.z)), put(std::uint8_t{7});
        }
    }
    for (const auto& polygon : p.polygons) {
        if (kind == PlyKind::text) {
            std::string line = std::to_string(polygon.size());
            for (const unsigned i : polygon) line.append(" ").append(std::to_string(i));
            append_bytes(out, line + "\n");
        } else {
            put(static_cast<std::uint8_t>(polygon.size()));
            for (const unsigned i : polygon) put(static_cast<std::int32_t>(i));
        }
    }
    return out;
}

inline Bytes obj_of(const Polyhedron& p) {
    std::string text = "# a letter\no letter\n";
    for (const Vec3f& v : p.points) text += "v " + text_of(v) + "\n";
    for (std::size_t f = 0; f < p.polygons.size(); ++f) {
        text += "f";
        for (const unsigned i : p.polygons[f])  // odd faces count from the end
            text.append(" ").append(
                std::to_string(f % 2 == 0 ? static_cast<int>(i) + 1 : static_cast<int>(i) - static_cast<int>(p.points.size())));
        text += "\n";
    }
    return to_bytes(text);
}

/// A ZIP file; the files are deflated if `packed`.
inline Bytes zip_of(const std::vector<std::pair<std::string, Bytes>>& files, bool packed) {
    Bytes out, directory;
    for (const auto& [name, data] : files) {
        Bytes body = data;
        if (packed) {
            libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
            body.resize(libdeflate_deflate_compress_bound(compressor, data.size()));
            body.resize(libdeflate_deflate_compress(compressor, data.data(), data.size(), body.data(), body.size()));
            libdeflate_free_compressor(compressor);
        }
        const auto offset = static_cast<std::uint32_t>(out.size());
        const auto fields = [&](Bytes& to) {
            append<std::uint16_t>(to, {20, 0, static_cast<std::uint16_t>(packed ? 8 : 0), 0, 0x21});
            append<std::uint32_t>(to, {libdeflate_crc32(0, data.data(), data.size()), static_cast<std::uint32_t>(body.size()),
                                       static_cast<std::uint32_t>(data.size())});
            append<std::uint16_t>(to, {static_cast<std::uint16_t>(name.size()), 0});
        };
        append_u32(out, 0x04034b50);
        fields(out);
        append_bytes(out, name);
        out.insert(out.end(), body.begin(), body.end());
        append_u32(directory, 0x02014b50);
        append<std::uint16_t>(directory, {20});
        fields(directory);
        append<std::uint16_t>(directory, {0, 0, 0});
        append<std::uint32_t>(directory, {0, offset});
        append_bytes(directory, name);
    }
    const auto at = static_cast<std::uint32_t>(out.size());
    out.insert(out.end(), directory.begin(), directory.end());
    append_u32(out, 0x06054b50);
    append<std::uint16_t>(out, {0, 0, static_cast<std::uint16_t>(files.size()), static_cast<std::uint16_t>(files.size())});
    append<std::uint32_t>(out, {static_cast<std::uint32_t>(directory.size()), at});
    append<std::uint16_t>(out, {0});
    return out;
}

inline Bytes three_mf(const std::string& model, bool packed = true) {
    return zip_of({{"[Content_Types].xml", to_bytes("<Types/>")}, {"3D/3dmodel.model", to_bytes(model)}}, packed);
}

/// A model's text: `resources` and `build` go into it.
inline std::string three_mf_text(const std::string& unit, const std::string& resources, const std::string& build) {
    return "<?xml version=\"1.0\"?>\n<model unit=\"" + unit +
           "\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
           "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"><resources>" +
           resources + "</resources><build>" + build + "</build></model>";
}

/// scale: of the coordinates; triangle_members: further attributes of each triangle.
inline std::string three_mf_mesh(const Polyhedron& p, float scale = 1.0f, const std::vector<std::string>& triangle_members = {}) {
    std::string text = "<mesh><vertices>";
    for (const Vec3f& point : p.points) {
        const Vec3f v = z_up(point) * scale;
        text += "<vertex x=\"" + text_of(v.x) + "\" y=\"" + text_of(v.y) + "\" z=\"" + text_of(v.z) + "\"/>";
    }
    text += "</vertices><triangles>";
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
        const auto& [a, b, c] = p.triangles[t];
        text += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" + std::to_string(c) + "\" " +
                (t < triangle_members.size() ? triangle_members[t] : "") + "/>";
    }
    return text + "</triangles></mesh>";
}

inline Result<LoadedScene> load_any(const Bytes& bytes, const LoadOptions& options = strictly(), const std::string& base_dir = "") {
    return load_model_bytes(bytes, "test.model", base_dir, options);
}

inline LoadedScene load_any_ok(const Bytes& bytes, const LoadOptions& options = {}, const std::string& base_dir = "") {
    auto loaded = load_any(bytes, options, base_dir);
    if (!loaded) FAIL("refused: " << loaded.error().message);
    return *std::move(loaded);
}

inline LoadedScene read(const std::string& text) { return load_any_ok(to_bytes(text)); }

inline bool is_warned(const LoadedScene& loaded, const char* part) {
    for (const std::string& warning : loaded.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

/// The message of a file that must be refused.
inline std::string refusal_of(const Bytes& file, ErrorCode code = ErrorCode::bad_input, const LoadOptions& options = strictly()) {
    const auto loaded = load_any(file, options);
    if (loaded) FAIL("was loaded");
    CHECK(loaded.error().code == code);
    return loaded.error().message;
}

}  // namespace halflit::test
