// One set of 3D Gaussians in each format that is read, and damaged files.
#include "apps/io/pictures/webp_encoder.hpp"
#include "halflit/image.hpp"
#include "halflit/model.hpp"
#include "tests/io/model_maker.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <libdeflate.h>
#if HALFLIT_HAS_KTX2
#include <zstd.h>
#endif

#include <cmath>
#include <cstring>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

constexpr double kY0 = 0.28209479177387814, kY1 = 0.4886025119029199, kRoot = 0.70710678118654752;

using Three = std::array<double, 3>;
struct One {
    Three position, scale;
    std::array<double, 4> rotation;  // w, x, y, z
    double opacity;
    Three color, rest[3];  // rest: coefficients of degree 1
};
// x points right, y down, z ahead.
const One kThree[] = {{{0, 0, 0}, {.5, .1, .1}, {1, 0, 0, 0}, .95, {1, .2, .2}, {{.2, 0, .1}, {0, -.2, .3}, {.1, .1, 0}}},
                      {{0, -1, 0}, {.3, .3, .2}, {kRoot, .5, .5, 0}, .8, {.2, 1, .2}, {{0, .4, 0}, {.1, 0, 0}, {0, 0, -.4}}},
                      {{1, 0, .5}, {.1, .4, .1}, {.3826834, 0, 0, -.9238795}, .6, {.2, .2, 1}, {{0, 0, 0}, {.3, .3, .3}, {0, 0, 0}}}};

/// Axes of SPZ: its number, their directions, and the rotation from the axes above, without its mirror.
struct Axes {
    std::uint32_t number;
    Three rows[3];
    std::array<double, 4> turn;
};
const Axes kAxes[] = {{4, {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 1, 0, 0}},           // right up back
                      {12, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {kRoot, -kRoot, 0, 0}},  // right front up
                      {7, {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {0, 0, 0, 1}},           // left up front
                      {3, {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {1, 0, 0, 0}}};         // left up back, which is mirrored

Three times(const Three (&rows)[3], const Three& v) {
    Three out{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) out[r] += rows[r][c] * v[c];
    return out;
}

One turned(One s, const Axes& axes) {
    s.position = times(axes.rows, s.position);
    const auto [a, b, c, d] = axes.turn;
    const auto [w, x, y, z] = s.rotation;
    s.rotation = {a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
                  a * z + b * y - c * x + d * w};
    for (std::size_t channel = 0; channel < 3; ++channel) {  // the light of degree 1 is a vector: -x, -y, z are the coefficients 2, 0, 1
        const Three to = times(axes.rows, {-s.rest[2][channel], -s.rest[0][channel], s.rest[1][channel]});
        s.rest[2][channel] = -to[0], s.rest[0][channel] = -to[1], s.rest[1][channel] = to[2];
    }
    return s;
}

// ---- files ---------------------------------------------------------------------------------------------------------------

void put_code(Bytes& to, double code) { to.push_back(static_cast<std::byte>(std::clamp(std::lround(code), 0L, 255L))); }
void put_float(Bytes& to, double value) { append<float>(to, {static_cast<float>(value)}); }
std::uint32_t code_of(double share, std::uint32_t most) { return static_cast<std::uint32_t>(std::lround(share * most)); }

/// The three components other than the largest, in order, with the sign that makes that one positive; and its place.
std::pair<Three, std::uint32_t> smallest(const std::array<double, 4>& q) {
    std::uint32_t largest = 0;
    for (std::uint32_t k = 1; k < 4; ++k)
        if (std::fabs(q[k]) > std::fabs(q[largest])) largest = k;
    Three others{};
    for (std::size_t k = 0, n = 0; k < 4; ++k)
        if (k != largest) others[n++] = q[largest] < 0 ? -q[k] : q[k];
    return {others, largest};
}

Bytes as_ply(const std::string& comment = "", bool flat = false) {
    std::string header = "ply\nformat binary_little_endian 1.0\n" + comment + "element vertex 3\n";
    for (const std::string name : {"x",        "y",        "z",        "f_dc_0",   "f_dc_1",   "f_dc_2",   "f_rest_0", "f_rest_1",
                                   "f_rest_2", "f_rest_3", "f_rest_4", "f_rest_5", "f_rest_6", "f_rest_7", "f_rest_8", "opacity",
                                   "scale_0",  "scale_1",  "scale_2",  "rot_0",    "rot_1",    "rot_2",    "rot_3"})
        if (!flat || name != "scale_2") header += "property float " + name + "\n";
    Bytes file = to_bytes(header + "end_header\n");
    for (const One& s : kThree) {
        for (const double p : s.position) put_float(file, p);
        for (const double c : s.color) put_float(file, (c - .5) / kY0);
        for (std::size_t c = 0; c < 3; ++c)
            for (const Three& k : s.rest) put_float(file, k[c]);
        put_float(file, std::log(s.opacity / (1 - s.opacity)));
        for (std::size_t c = 0; c < (flat ? 2u : 3u); ++c) put_float(file, std::log(s.scale[c]));
        for (const double q : s.rotation) put_float(file, q);
    }
    return file;
}

Bytes as_compressed_ply() {
    std::string header = "ply\nformat binary_little_endian 1.0\nelement chunk 1\n";
    for (const char* const end : {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y", "min_scale_z",
                                  "max_scale_x", "max_scale_y", "max_scale_z"})
        header += std::string("property float ") + end + "\n";
    header += "element vertex 3\n";
    for (const char* const name : {"position", "rotation", "scale", "color"}) header += std::string("property uint packed_") + name + "\n";
    header += "element sh 3\n";
    for (int k = 0; k < 9; ++k) header += "property uchar f_rest_" + std::to_string(k) + "\n";
    Bytes file = to_bytes(header + "end_header\n");
    for (const double end : {-1., -1., -1., 1., 1., 1., -3., -3., -3., 0., 0., 0.}) put_float(file, end);
    for (const One& s : kThree) {
        const auto place = [](double x, double y, double z) { return code_of(x, 2047) << 21 | code_of(y, 1023) << 11 | code_of(z, 2047); };
        const auto log = [&](std::size_t c) { return std::log(s.scale[c]) / 3 + 1; };
        const auto [q, largest] = smallest(s.rotation);
        std::uint32_t turn = largest;
        for (const double part : q) turn = turn << 10 | code_of(part * kRoot + .5, 1023);
        append_u32(file, place(s.position[0] / 2 + .5, s.position[1] / 2 + .5, s.position[2] / 2 + .5));
        append_u32(file, turn);
        append_u32(file, place(log(0), log(1), log(2)));
        append_u32(file, code_of(s.color[0], 255) << 24 | code_of(s.color[1], 255) << 16 | code_of(s.color[2], 255) << 8 |
                             code_of(s.opacity, 255));
    }
    for (const One& s : kThree)
        for (std::size_t c = 0; c < 3; ++c)
            for (const Three& k : s.rest) put_code(file, (k[c] / 8 + .5) * 256 - .5);
    return file;
}

Bytes as_splat() {
    Bytes file;
    for (const One& s : kThree) {
        for (const double p : s.position) put_float(file, p);
        for (const double r : s.scale) put_float(file, r);
        for (const double c : s.color) put_code(file, c * 255);
        put_code(file, s.opacity * 255);
        for (const double q : s.rotation) put_code(file, q * 128 + 128);
    }
    return file;
}

/// Half precision, of numbers that it has.
std::uint16_t half_of(double value) {
    if (value == 0) return 0;
    const int exponent = std::ilogb(value);
    const double fraction = std::ldexp(std::fabs(value), -exponent) - 1;
    return static_cast<std::uint16_t>((value < 0 ? 0x8000 : 0) | (exponent + 15) << 10 | static_cast<int>(fraction * 1024));
}

enum class Packing : std::uint8_t { plain, gzip, zstd };

Bytes as_spz(std::uint32_t version, Packing packing, const Axes* named = nullptr) {
    std::array<Bytes, 6> columns;
    for (const One& as_given : kThree) {
        const One s = turned(as_given, named == nullptr ? kAxes[0] : *named);
        for (const double p : s.position) {
            if (version == 1)
                append<std::uint16_t>(columns[0], {half_of(p)});
            else
                for (int i = 0; i < 3; ++i) columns[0].push_back(static_cast<std::byte>(std::lround(p * 4096) >> 8 * i & 255));
        }
        put_code(columns[1], s.opacity * 255);
        for (const double c : s.color) put_code(columns[2], ((c - .5) / kY0 * .15 + .5) * 255);
        for (const double r : s.scale) put_code(columns[3], (std::log(r) + 10) * 16);
        const auto [w, x, y, z] = s.rotation;
        if (version < 3) {
            for (const double q : {x, y, z}) put_code(columns[4], (w < 0 ? -q : q) * 127.5 + 127.5);
        } else {
            const auto [q, largest] = smallest({x, y, z, w});
            std::uint32_t turn = largest;
            for (const double part : q) turn = turn << 10 | (part < 0 ? 512u : 0u) | code_of(std::fabs(part) / kRoot, 511);
            append_u32(columns[4], turn);
        }
        for (const Three& k : s.rest)
            for (const double c : k) put_code(columns[5], c * 128 + 128);
    }
    Bytes file = to_bytes("NGSP"), extension;
    append<std::uint32_t>(file, {version, 3});
    append<std::uint8_t>(file,
                         {1, 12, static_cast<std::uint8_t>(named == nullptr ? 0 : 2), static_cast<std::uint8_t>(version < 4 ? 0 : 6)});
    // Another extension stands before that of the axes.
    if (named != nullptr) append<std::uint32_t>(extension, {0xADBE0002, 12, 0, 0, 0, 0xADBE0003, 4, named->number});
    const auto add = [&](const Bytes& part) { file.insert(file.end(), part.begin(), part.end()); };
    if (packing != Packing::zstd) {
        for (const Bytes& column : columns) add(column);
        add(extension);
        if (packing == Packing::plain) return file;
        Bytes packed(file.size() + 1000);
        libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
        packed.resize(libdeflate_gzip_compress(compressor, file.data(), file.size(), packed.data(), packed.size()));
        libdeflate_free_compressor(compressor);
        return packed;
    }
    append<std::uint32_t>(file, {static_cast<std::uint32_t>(32 + extension.size()), 0, 0, 0});
    add(extension);
#if HALFLIT_HAS_KTX2
    Bytes streams;
    for (const Bytes& column : columns) {
        Bytes packed(ZSTD_compressBound(column.size()));
        packed.resize(ZSTD_compress(packed.data(), packed.size(), column.data(), column.size(), 3));
        append<std::uint64_t>(file, {packed.size(), column.size()});
        streams.insert(streams.end(), packed.begin(), packed.end());
    }
    add(streams);
#endif
    return file;
}

/// with_skin: of joints that a mesh of three vertices has.
Bytes as_glb(const Bytes& spz, bool with_skin = false) {
    const std::string size = std::to_string(spz.size());
    std::string json =
        R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_gaussian_splatting","KHR_gaussian_splatting_compression_spz_2"],)"
        R"("extensionsRequired":["KHR_gaussian_splatting_compression_spz_2"],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0},{}],)"
        R"("meshes":[{"primitives":[{"mode":0,"attributes":{"POSITION":0},"extensions":{"KHR_gaussian_splatting":{"extensions":)"
        R"({"KHR_gaussian_splatting_compression_spz_2":{"bufferView":0}}}}}]}],"bufferViews":[{"buffer":0,"byteLength":)" +
        size + R"(}],"accessors":[{"componentType":5126,"count":3,"type":"VEC3"},{"componentType":5121,"count":3,"type":"VEC4"},)" +
        R"({"componentType":5126,"count":3,"type":"VEC4"}],"skins":[{"joints":[1]}],"buffers":[{"byteLength":)" + size + "}]}";
    if (with_skin) {
        json = replaced(json, R"({"mesh":0})", R"({"mesh":0,"skin":0})");
        json = replaced(json, R"("POSITION":0)", R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2)");
    }
    return glb(json, spz);
}

#if HALFLIT_HAS_WEBP
/// damage: changes bytes of the files in the ZIP file, whose checksums fit.
Bytes as_sog(bool packed, const std::string& folder = "", Random* damage = nullptr) {
    std::array<Image, 7> pictures;  // low, high, quats, scales, sh0, palette, labels
    for (Image& picture : pictures) picture.width = 4, picture.height = 1, picture.rgba8.assign(16, 0);
    pictures[5].width = 192, pictures[5].rgba8.assign(4 * 192, 0);
    const auto put = [&](std::size_t picture, std::size_t at, double code) {
        pictures[picture].rgba8[at] = static_cast<std::uint8_t>(std::clamp(std::lround(code), 0L, 255L));
    };
    std::string scales, colors, rests;
    for (int i = 0; i < 256; ++i) {
        const std::string comma = i == 0 ? "" : ",";
        scales += comma + (i == 0 ? "null" : std::to_string(-3 + i * 3 / 255.));
        colors += comma + std::to_string(-2 + i * 4 / 255.);
        rests += comma + std::to_string(-.5 + i / 255.);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const One& s = kThree[i];
        const auto [q, largest] = smallest(s.rotation);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t place = code_of((std::copysign(std::log1p(std::fabs(s.position[c])), s.position[c]) + 1) / 2, 65535);
            put(0, 4 * i + c, place & 255u), put(1, 4 * i + c, place >> 8);
            put(2, 4 * i + c, (q[c] * kRoot + .5) * 255);
            put(3, 4 * i + c, (std::log(s.scale[c]) + 3) * 85);
            put(4, 4 * i + c, ((s.color[c] - .5) / kY0 + 2) * 255 / 4);
            for (std::size_t k = 0; k < 3; ++k) put(5, 4 * (3 * (i + 7) + k) + c, (s.rest[k][c] + .5) * 255);
        }
        put(2, 4 * i + 3, 252 + largest), put(4, 4 * i + 3, s.opacity * 255), put(6, 4 * i, static_cast<double>(i + 7));
    }
    const std::string json =
        R"({"version":2,"count":3,"means":{"mins":[-1,-1,-1],"maxs":[1,1,1],"files":["0.webp","1.webp"]},"quats":{"files":["2.webp"]},)"
        R"("scales":{"codebook":[)" +
        scales + R"(],"files":["3.webp"]},"sh0":{"codebook":[)" + colors +
        R"(],"files":["4.webp"]},"shN":{"count":64,"bands":1,"codebook":[)" + rests + R"(],"files":["5.webp","6.webp"]}})";
    std::vector<std::pair<std::string, Bytes>> files;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const auto picture = io::encode_webp(pictures[i]);
        REQUIRE(picture);
        const auto bytes = std::as_bytes(std::span(*picture));
        files.emplace_back(folder + std::to_string(i) + ".webp", Bytes(bytes.begin(), bytes.end()));
    }
    files.emplace_back(folder + "meta.json", to_bytes(json));
    for (auto& [name, bytes] : files)
        for (int i = damage == nullptr ? 0 : damage->index(3); i > 0; --i)
            bytes[static_cast<std::size_t>(damage->index(static_cast<int>(bytes.size())))] = static_cast<std::byte>(damage->index(256));
    return zip_of(files, packed);
}
#endif

struct Named {
    Bytes file;
    std::string name;
    double slack;  // of positions, colours, and shares of the largest variance
};
std::vector<Named> all_files() {
    std::vector<Named> files{{as_ply(), "plain.ply", 1e-5},
                             {as_compressed_ply(), "packed.ply", .02},
                             {as_splat(), "a.splat", .02},
                             {as_spz(1, Packing::gzip), "1.spz", .08},
                             {as_spz(2, Packing::gzip), "2.spz", .08},
                             {as_spz(2, Packing::plain), "told by its bytes", .08},
                             {as_spz(3, Packing::gzip), "told by its bytes too", .07},
                             {as_glb(as_spz(2, Packing::gzip)), "2.glb", .08}};
    for (const Axes& axes : kAxes) files.push_back({as_spz(3, Packing::gzip, &axes), "axes " + std::to_string(axes.number), .07});
#if HALFLIT_HAS_KTX2
    files.push_back({as_spz(4, Packing::zstd), "-", .07});
    files.push_back({as_spz(4, Packing::zstd, &kAxes[1]), "4.spz", .07});
#endif
#if HALFLIT_HAS_WEBP
    files.push_back({as_sog(false), "a.sog", .02});
    files.push_back({as_sog(true, "scan/"), "a.zip", .02});
#endif
    return files;
}

Result<LoadedScene> loaded(const Bytes& file, const std::string& name, bool strict = false) {
    LoadOptions options;
    options.strict = strict;
    return load_model_bytes(file, name, "", options);
}
LoadedScene sound(const Bytes& file, const std::string& name) {
    auto scene = loaded(file, name);
    if (!scene) FAIL(name << ": " << scene.error().message);
    return *std::move(scene);
}
const Splats& splats_of(const LoadedScene& scene) {
    REQUIRE(scene.scene.meshes.size() == 1);
    REQUIRE(scene.scene.meshes[0].splats != nullptr);
    return *scene.scene.meshes[0].splats;
}
std::size_t warnings_of(const LoadedScene& scene, std::string_view part) {
    return static_cast<std::size_t>(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                                                  [&](const std::string& warning) { return warning.find(part) != std::string::npos; }));
}

// ---- what is seen of them ------------------------------------------------------------------------------------------------

/// Position, variances and colour from one side, in the world.
struct Seen {
    Three position, variance[3], color;
};
Seen seen(const One& s, const Three (&world)[3], const Three& origin) {
    Seen out{times(world, s.position), {}, {}};
    for (std::size_t c = 0; c < 3; ++c) out.position[c] += origin[c];
    const auto [w, x, y, z] = s.rotation;
    const Three turn[3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Three along{};
        for (std::size_t r = 0; r < 3; ++r) along[r] = turn[r][axis] * s.scale[axis];
        along = times(world, along);
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c) out.variance[r][c] += along[r] * along[c];
    }
    constexpr double kDirection[3] = {.48, .6, .64};
    Three d{};  // in the file's axes
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) d[c] += world[r][c] * kDirection[r];
    for (std::size_t c = 0; c < 3; ++c)
        out.color[c] = s.color[c] + kY1 * (-d[1] * s.rest[0][c] + d[2] * s.rest[1][c] - d[0] * s.rest[2][c]);
    return out;
}

}  // namespace

TEST_CASE("splat files: each format holds the same three Gaussians, which stand upright", "[io][splats]") {
    const Three upright[3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    for (const auto& [file, name, slack] : all_files()) {
        INFO(name);
        const LoadedScene scene = sound(file, name);
        CHECK(warnings_of(scene, "") == 0);
        const Splats& s = splats_of(scene);
        const Mesh& mesh = scene.scene.meshes[0];
        REQUIRE(s.opacities.size() == 3);
        CHECK(s.degree == (name == "a.splat" ? 0 : 1));
        CHECK(s.reference == (name == "2.glb" ? SplatReference::khr : SplatReference::inria));
        const Mat4& m = scene.scene.instances[0].world_from_object;
        const Three world[3] = {{m.c[0].x, m.c[1].x, m.c[2].x}, {m.c[0].y, m.c[1].y, m.c[2].y}, {m.c[0].z, m.c[1].z, m.c[2].z}};
        for (std::size_t i = 0; i < 3; ++i) {
            One one{{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z},
                    {s.scales[i].x, s.scales[i].y, s.scales[i].z},
                    {s.rotations[i].w, s.rotations[i].x, s.rotations[i].y, s.rotations[i].z},
                    s.opacities[i],
                    {},
                    {}};
            const std::size_t coefficients = s.degree == 0 ? 1 : 4;
            for (std::size_t c = 0; c < 3; ++c) {
                one.color[c] = .5 + kY0 * static_cast<double>(s.harmonics[3 * coefficients * i + c]);
                for (std::size_t k = 1; k < coefficients; ++k) one.rest[k - 1][c] = s.harmonics[3 * (coefficients * i + k) + c];
            }
            One whole = kThree[i];
            if (s.degree == 0) std::fill(std::begin(whole.rest), std::end(whole.rest), Three{});
            const Seen found = seen(one, world, {m.c[3].x, m.c[3].y, m.c[3].z}), wanted = seen(whole, upright, {});
            const double largest = *std::max_element(whole.scale.begin(), whole.scale.end());
            CHECK(std::fabs(one.opacity - whole.opacity) < slack);
            for (std::size_t c = 0; c < 3; ++c) {
                CHECK(std::fabs(found.position[c] - wanted.position[c]) < slack);
                CHECK(std::fabs(found.color[c] - wanted.color[c]) < slack);
                for (std::size_t r = 0; r < 3; ++r)
                    CHECK(std::fabs(found.variance[r][c] - wanted.variance[r][c]) < slack * largest * largest);
            }
        }
        CHECK(mesh.indices.size() == 3 + 18);  // and the ends of their axes
    }
}

TEST_CASE("splat files: a host that names the axis that is up gets the coordinates of the file", "[io][splats]") {
    LoadOptions options;
    options.up = UpAxis::minus_y;
    const auto named = load_model_bytes(as_ply(), "plain.ply", "", options);
    REQUIRE(named);
    CHECK(named->placement.up == UpAxis::minus_y);
    const LoadedScene plain = sound(as_ply(), "plain.ply");
    CHECK(plain.placement.up == UpAxis::y);
    const Mat4 &a = named->scene.instances[0].world_from_object, &b = plain.scene.instances[0].world_from_object;
    for (int c = 0; c < 4; ++c) CHECK(a.c[c] == b.c[c]);
}

TEST_CASE("splat files: comments of PLY say how Gaussians are drawn", "[io][splats]") {
    const auto reference = [](const char* comment) {
        return splats_of(sound(as_ply("comment " + std::string(comment) + "\n"), "a.ply")).reference;
    };
    CHECK(reference("SplatRenderMode: mip") == SplatReference::mip);
    CHECK(reference("splatrendermode: default") == SplatReference::inria);
    CHECK(reference("antialiased 1") == SplatReference::inria_aa);
    CHECK(reference("antialiased 0") == SplatReference::inria);
    CHECK(reference("antialiased") == SplatReference::inria);
    CHECK(warnings_of(sound(as_ply("comment SplatRenderMode: 2dgs\n"), "a.ply"), "2D Gaussians") == 1);
    const LoadedScene flat = sound(as_ply("", true), "a.ply");  // discs have two scales
    CHECK(warnings_of(flat, "2D Gaussians") == 1);
    CHECK(splats_of(flat).scales[1].z == 0.0f);
}

TEST_CASE("splat files: what is wrong costs as little as it can", "[io][splats]") {
    Bytes splat = as_splat();
    splat.resize(splat.size() - 5);
    const LoadedScene two = sound(splat, "a.splat");
    CHECK(splats_of(two).opacities.size() == 2);
    CHECK(warnings_of(two, "it was cut off: 2 of 3") == 1);
    CHECK_FALSE(loaded(splat, "a.splat", true));
    CHECK_FALSE(loaded(as_splat(), "a"));  // the name alone tells it
    CHECK_FALSE(loaded(to_bytes(std::string(64, 'x')), "a.splat"));
    CHECK(loaded(to_bytes("ksplat"), "a.ksplat").error().message.find("convert it by") != std::string::npos);

    splat = as_splat();
    put(splat, 32 + 12, -0.3f);                                                   // a scale
    for (std::size_t i = 0; i < 4; ++i) splat[2 * 32 + 28 + i] = std::byte{128};  // a rotation
    put(splat, 4, std::bit_cast<float>(0x7fc00000u));                             // a place
    const LoadedScene mended = sound(splat, "a.splat");
    CHECK(splats_of(mended).opacities.size() == 2);
    CHECK(splats_of(mended).scales[0].x == 0.3f);
    CHECK(splats_of(mended).rotations[1].w == 1.0f);
    CHECK(warnings_of(mended, "2 Gaussians have a rotation that is none, or a scale below 0") == 1);
    CHECK(warnings_of(mended, "1 Gaussians with numbers that are not finite") == 1);

    Bytes spz = as_spz(2, Packing::gzip);
    spz.resize(spz.size() / 2);
    CHECK(loaded(spz, "a.spz").error().message.find("cut off") != std::string::npos);
    spz = as_spz(9, Packing::plain);
    CHECK(loaded(spz, "a.spz").error().message.find("version 9") != std::string::npos);
    const Axes none{99, {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 1, 0, 0}};
    CHECK(warnings_of(sound(as_spz(3, Packing::gzip, &none), "a.spz"), "its axes have the number 99") == 1);
    CHECK_FALSE(loaded(as_glb(to_bytes("no SPZ file at all, of some length")), "a.glb"));
    CHECK(warnings_of(sound(as_glb(as_spz(2, Packing::gzip), true), "a.glb"), "a skin does not move 3D Gaussians") == 1);
#if HALFLIT_HAS_KTX2
    spz = as_spz(4, Packing::zstd);
    spz.pop_back();
    const LoadedScene plain = sound(spz, "a.spz");
    CHECK(splats_of(plain).degree == 0);
    CHECK(warnings_of(plain, "it was cut off; drawn without colours that change with the view") == 1);
    spz.resize(spz.size() / 2);
    CHECK(loaded(spz, "a.spz").error().message.find("cut off") != std::string::npos);
    Bytes large = as_spz(4, Packing::zstd);
    put(large, 8, 0xFFFFFFFFu);
    CHECK_FALSE(loaded(large, "a.spz"));
#endif
}

namespace {

void damage_each(int rounds) {
    Random random(4);
    for (const auto& [whole, name, slack] : all_files()) {
        for (int round = 0; round < rounds; ++round) {
            INFO(name << ", round " << round);
            Bytes file = whole;
            if (round % 3 == 0) file.resize(static_cast<std::size_t>(random.integer(0, static_cast<int>(file.size()))));
            for (int i = 0; i < round % 5 && !file.empty(); ++i)
                file[static_cast<std::size_t>(random.index(static_cast<int>(file.size())))] = static_cast<std::byte>(random.index(256));
            const auto scene = loaded(file, name);
            if (!scene) CHECK_FALSE(scene.error().message.empty());
        }
    }
#if HALFLIT_HAS_WEBP
    for (int round = 0; round < rounds; ++round) (void)loaded(as_sog(false, "", &random), "a.sog");
#endif
}

}  // namespace

TEST_CASE("splat files: damaged ones end with an error or what can be read", "[io][splats]") {
    damage_each(300);
    const Bytes ply = as_ply();
    std::string endless(reinterpret_cast<const char*>(ply.data()), ply.size());
    endless.replace(endless.find("vertex 3"), 8, "vertex 4000000000");
    CHECK(loaded(to_bytes(endless), "a.ply"));  // what is there is read
}

TEST_CASE("splat files: many damaged ones end with an error or what can be read", "[io][splats][slow]") { damage_each(5000); }
