// Random damage to STL, PLY, OBJ and 3MF files: whatever the bytes, loading ends with a sound scene or an error, in bounded memory.
#include "apps/io/platform/process.hpp"
#include "tests/io/model_maker.hpp"

#include "tests/support/catch.hpp"

#include <random>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

/// Flips bits, replaces bytes, cuts, removes and repeats pieces, and replaces numbers.
void damage(Bytes& file, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
    static const char* const kNumbers[] = {"-1",   "0",   "1",    "-0",    "4294967295", "2147483648", "18446744073709551616",
                                           "1e39", "nan", "-inf", "1e-60", "7",          "99999999",   "0.5",
                                           "/",    "x"};
    if (file.empty()) return;
    const auto at = [&](std::size_t i) { return file.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t from = below(file.size());
    const std::size_t piece = std::min(1 + below(40), file.size() - from);
    switch (random() % 6) {
        case 0:
            file[from] ^= static_cast<std::byte>(1u << random() % 8);
            break;
        case 1:
            file[from] = static_cast<std::byte>(random());
            break;
        case 2:
            file.resize(from);
            break;
        case 3:
            file.erase(at(from), at(from + piece));
            break;
        case 4: {
            const Bytes copy(at(from), at(from + piece));
            const std::size_t to = below(file.size());
            file.insert(at(to), copy.begin(), copy.end());
            break;
        }
        default: {  // a number in place of the next one
            const auto is_digit = [](std::byte b) { return b >= std::byte{'0'} && b <= std::byte{'9'}; };
            std::size_t first = from;
            while (first < file.size() && !is_digit(file[first])) ++first;
            std::size_t end = first;
            while (end < file.size() && is_digit(file[end])) ++end;
            const Bytes number = to_bytes(kNumbers[below(std::size(kNumbers))]);
            file.erase(at(first), at(end));
            file.insert(at(first), number.begin(), number.end());
        }
    }
}

std::size_t peak_kib() { return static_cast<std::size_t>(platform::peak_memory()) / 1024; }

/// The formats, with all that their readers know.
std::vector<std::pair<std::string, Bytes>> rich_files() {
    const Polyhedron object = letter();
    std::vector<std::uint16_t> attributes;
    for (std::size_t t = 0; t < object.triangles.size(); ++t) attributes.push_back(static_cast<std::uint16_t>(t * 4099));
    std::string obj = "mtllib a.mtl\nvt 0 0\nvt 1 0 0\nvn 0 0 1\nv 9 9 9 1 0.5 0\n";
    const Bytes plain = obj_of(object);
    obj += std::string(reinterpret_cast<const char*>(plain.data()), plain.size());
    obj += "usemtl b\ns 1\nf 1/1/1 3//1 4/2 \\\n 5\nl 1 2\ns off\no c\nf -1 -2 -3\n";
    const std::string ply =
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoordinates\nelement other 1\n"
        "property list uint8 int8 z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0 0 0 1 1 2 3\n1 0 0 0 0 1 255 0 3\n1 1 0 0 0 0 1 2 3\n0 1 0 0 0 1 1 2 3\n"
        "4 0 1 2 3 2 0.5 1\n3 0 1 2 0\n2 3 4\n5 0 1 2 -1 3\n";
    const std::string off =
        "STCNOFF\n5 3 0\n0 0 0 0 0 1 255 0 3 255 0 0\n1 0 0 0 0 1 1 2 3 255 1 0\n1 1 0 0 0 1 9 9 9 255 1 1\n"
        "0 1 0 0 0 1 1 2 3 255 0 1\n0.5 0.5 2 0 0 1 200 0 0 255 0.5 0.5\n4 0 1 2 3\n3 0 1 4 255 0 0\n3 1 2 4 0.5 0.5 1\n";
    const std::string resources =
        "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#FF0000\"/></basematerials>"
        "<m:colorgroup id=\"6\"><m:color color=\"#00FF00\"/><m:color color=\"#0000FF80\"/></m:colorgroup>"
        "<object id=\"1\" pid=\"5\" pindex=\"0\">" +
        three_mf_mesh(object, 1.0f, {"pid=\"6\" p1=\"0\"", "pid=\"6\" p1=\"1\" p2=\"0\""}) +
        "</object><object id=\"2\"><components><component objectid=\"1\"/>"
        "<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 20 30\"/></components></object>";
    std::vector<std::pair<std::string, Bytes>> files = {{"STL text", stl_text_of(object)},
                                                        {"STL binary", stl_binary_of(object, "solid COLOR=1234", attributes)},
                                                        {"PLY little endian", ply_of(object, PlyKind::little)},
                                                        {"PLY big endian", ply_of(object, PlyKind::big)},
                                                        {"PLY text", to_bytes(ply)},
                                                        {"OBJ", to_bytes(obj)},
                                                        {"OFF", to_bytes(off)}};
    if (has_three_mf())
        files.emplace_back("3MF", to_bytes(three_mf_text("inch", resources, "<item objectid=\"2\"/><item objectid=\"1\"/>")));
    return files;
}

void check_sound(const LoadedScene& loaded) {
    // Vertices at float32's end become NaN, with a warning.
    const bool leaves_strays_out =
        std::any_of(loaded.warnings.begin(), loaded.warnings.end(), [](const std::string& w) { return w.find("1e12 times") != w.npos; });
    for (const Mesh& mesh : loaded.scene.meshes) {
        const std::size_t n = mesh.positions.size();
        const auto fits = [n](const auto& values) { return values.empty() || values.size() == n; };
        const bool lit = mesh.topology == Topology::triangles;
        if (mesh.indices.size() % corners_of(mesh.topology) != 0 || (lit ? mesh.normals.size() != n : !fits(mesh.normals)) ||
            !fits(mesh.uv0) || !fits(mesh.colors))
            FAIL("lengths differ");
        for (const std::uint32_t index : mesh.indices)
            if (index >= n) FAIL("index " << index << " of " << n);
        for (const Vec3f& p : mesh.positions)
            if (!leaves_strays_out && !(p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0)) FAIL("not finite");
        if (mesh.material < 0 || mesh.material >= static_cast<int>(loaded.scene.materials.size())) FAIL("material " << mesh.material);
    }
    for (const Instance& instance : loaded.scene.instances)
        if (instance.mesh < 0 || instance.mesh >= static_cast<int>(loaded.scene.meshes.size())) FAIL("mesh " << instance.mesh);
}

void damage_each(unsigned times) {
    for (const auto& [name, good] : rich_files()) {
        INFO(name);
        // 3MF: the text is damaged and packed afterwards, or the package is damaged.
        const auto packed = [&, is_3mf = name == "3MF"](const Bytes& file) {
            return is_3mf ? zip_of({{"3D/3dmodel.model", file}}, false) : file;
        };
        LoadOptions undamaged;
        load_any_ok(packed(good), undamaged);
        const std::size_t before = peak_kib();
        std::size_t loaded_count = 0, refused_count = 0;
        for (unsigned seed = 0; seed < times; ++seed) {
            INFO("seed " << seed);
            std::mt19937 random(seed);
            const bool damages_package = name == "3MF" && seed % 4 == 0;
            Bytes file = damages_package ? packed(good) : good;
            for (unsigned i = 0; i <= seed % 3; ++i) damage(file, random);
            if (!damages_package) file = packed(file);
            LoadOptions options;
            options.strict = seed % 5 != 0;
            const auto result = load_any(file, options);
            if (result) {
                ++loaded_count;
                check_sound(*result);
                continue;
            }
            ++refused_count;
            check_refusal(result.error());
        }
        CHECK(loaded_count > times / 50);
        CHECK(refused_count > times / 50);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        static_cast<void>(before);  // sanitizers keep what was freed
#else
        CHECK(peak_kib() - before < 128 * 1024);  // 32 MiB of geometry, and 64 MiB of an unpacked part
#endif
    }
}

}  // namespace

TEST_CASE("models: damaged files of each format give a sound scene or an error", "[io]") { damage_each(2000); }

TEST_CASE("models: many damaged files of each format give a sound scene or an error", "[io][slow]") { damage_each(20000); }
