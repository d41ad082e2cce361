// Random damage: whatever the bytes, loading ends with a scene or an error.
#include "tests/io/rich_file.hpp"

#include "tests/support/catch.hpp"

#include <random>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

/// Flips bits, puts in interesting bytes, moves, cuts and repeats pieces, or changes a number of the JSON.
void damage(Bytes& file, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
    const auto at = [&] { return static_cast<std::ptrdiff_t>(below(file.size())); };
    static constexpr std::uint8_t kBytes[] = {0,   1,   127, 128, 254, 255, '"', '{', '}',  '[',
                                              ']', ',', ':', '-', '0', '9', 'e', '.', '\\', ' '};
    static const char* const kNumbers[] = {
        "-1",    "0",      "1",   "2",    "3",  "255", "65536", "2147483647", "2147483648", "4294967295", "9007199254740993",
        "1e308", "1e-320", "0.5", "null", "{}", "[]",  "\"\""};
    if (file.empty()) return;
    switch (random() % 7) {
        case 0:
            file[below(file.size())] ^= static_cast<std::byte>(1u << random() % 8);
            break;
        case 1:
            file[below(file.size())] = static_cast<std::byte>(kBytes[random() % std::size(kBytes)]);
            break;
        case 2:
            file.resize(below(file.size()));
            break;
        case 3: {  // remove a piece
            const std::ptrdiff_t from = at();
            file.erase(file.begin() + from, file.begin() + from +
                                                static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                                    1 + random() % 16, file.size() - static_cast<std::size_t>(from))));
            break;
        }
        case 4: {  // repeat a piece
            const std::ptrdiff_t from = at();
            const Bytes piece(file.begin() + from, file.begin() + from +
                                                       static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                                           1 + random() % 64, file.size() - static_cast<std::size_t>(from))));
            file.insert(file.begin() + at(), piece.begin(), piece.end());
            break;
        }
        default: {  // another number in place of one
            std::size_t from = below(file.size());
            const auto digit = [&](std::size_t i) { return file[i] >= std::byte{'0'} && file[i] <= std::byte{'9'}; };
            while (from < file.size() && !digit(from)) ++from;
            std::size_t end = from;
            while (end < file.size() && digit(end)) ++end;
            file.erase(file.begin() + static_cast<std::ptrdiff_t>(from), file.begin() + static_cast<std::ptrdiff_t>(end));
            const Bytes number = to_bytes(kNumbers[random() % std::size(kNumbers)]);
            file.insert(file.begin() + static_cast<std::ptrdiff_t>(from), number.begin(), number.end());
        }
    }
}

/// Corrects the container's lengths, so that damage inside the chunks is reached.
void mend_lengths(Bytes& file, std::size_t json_size_was, std::size_t size_was) {
    if (file.size() < 28 || file.size() % 4 != 0) return;
    const std::size_t json_size = json_size_was + file.size() - size_was;
    if (json_size % 4 != 0 || 20 + json_size > file.size()) return;
    const auto total = static_cast<std::uint32_t>(file.size()), json = static_cast<std::uint32_t>(json_size);
    put(file, 8, total);
    put(file, 12, json);
}

}  // namespace

TEST_CASE("fuzz: the undamaged file loads whole", "[io]") {
    const LoadedScene loaded = load_ok(rich_file());
    CHECK(loaded.scene.meshes.size() == 2);
    CHECK(loaded.scene.cameras.size() == 1);
    CHECK(loaded.scene.lights.size() == 1);
    CHECK(loaded.scene.textures.size() == 2);
    CHECK(loaded.scene.materials.at(0).has_own_lobe);
}

TEST_CASE("fuzz: damaged files give a sound scene or an error", "[io]") {
    const Bytes good = rich_file();
    const std::uint32_t json_size = u32_of(good, 12);
    const Bytes text = rich_file(true);
    std::size_t loaded_count = 0, refused_count = 0;
    for (unsigned seed = 0; seed < 20000; ++seed) {
        std::mt19937 random(seed);
        Bytes file = seed % 2 == 0 ? good : text;
        const int times = 1 + static_cast<int>(random() % 3);
        for (int i = 0; i < times; ++i) damage(file, random);
        if (seed % 2 == 0) {
            while (file.size() % 4 != 0)
                file.insert(file.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(file.size(), 20)), std::byte{' '});
            mend_lengths(file, json_size, good.size());
        }
        LoadOptions options;
        options.strict = seed % 3 != 0;
        const auto result = load(file, options);
        INFO("seed " << seed);
        if (!result) {
            ++refused_count;
            check_refusal(result.error());
            continue;
        }
        ++loaded_count;
        for (const Mesh& mesh : result->scene.meshes) {
            const std::size_t n = mesh.positions.size();
            const auto fits = [n](const auto& values) { return values.empty() || values.size() == n; };
            const bool lit = mesh.topology == Topology::triangles;
            if (mesh.indices.size() % corners_of(mesh.topology) != 0 || (lit ? mesh.normals.size() != n : !fits(mesh.normals)) ||
                !fits(mesh.tangents) || !fits(mesh.uv0) || !fits(mesh.uv1) || !fits(mesh.colors))
                FAIL("lengths differ");
            for (const std::uint32_t index : mesh.indices)
                if (index >= n) FAIL("index " << index << " of " << n);
            if (mesh.material >= static_cast<int>(result->scene.materials.size())) FAIL("material " << mesh.material);
        }
        for (const Instance& instance : result->scene.instances)
            if (instance.mesh < 0 || instance.mesh >= static_cast<int>(result->scene.meshes.size())) FAIL("mesh " << instance.mesh);
        for (const Material& m : result->scene.materials)
            for (const TextureUse& use : m.textures)
                if (use.texture >= static_cast<int>(result->scene.textures.size())) FAIL("texture " << use.texture);
    }
    INFO(loaded_count << " loaded, " << refused_count << " refused");
    CHECK(loaded_count > 500);  // files that are refused at once would test little
    CHECK(refused_count > 5000);
}
