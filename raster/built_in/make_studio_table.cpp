// Writes the source file of the studio's light.
//   halflit_make_studio_table FILE
#include "raster/built_in/studio_light.hpp"

#include <bit>
#include <cinttypes>
#include <cstdio>
#include <vector>

using namespace halflit;

namespace {

template <class Word>
void write_array(std::FILE* file, const char* type, const char* name, const std::vector<Word>& words) {
    std::fprintf(file, "const %s %s[] = {", type, name);
    for (std::size_t i = 0; i < words.size(); ++i)
        std::fprintf(file, "%s0x%" PRIx64 ",", i % 12 == 0 ? "\n" : "", static_cast<std::uint64_t>(words[i]));
    std::fprintf(file, "};\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const shading::ImageLightParts parts = raster::computed_studio_parts();
    std::vector<std::uint32_t> sizes, floats;
    std::vector<std::uint64_t> doubles;
    raster::for_each_number(
        parts, [&](std::int32_t size) { sizes.push_back(static_cast<std::uint32_t>(size)); }, [] {},
        [&](float value) { floats.push_back(std::bit_cast<std::uint32_t>(value)); },
        [&](double value) { doubles.push_back(std::bit_cast<std::uint64_t>(value)); });
    std::FILE* const file = std::fopen(argv[1], "w");
    if (file == nullptr) return 4;
    std::fprintf(file, "// Made by raster/built_in/make_studio_table.cpp.\n#include \"raster/built_in/studio_light.hpp\"\n");
    std::fprintf(file, "namespace halflit::raster {\n");
    write_array(file, "std::uint32_t", "kStudioSizes", sizes);
    write_array(file, "std::uint32_t", "kStudioFloats", floats);
    write_array(file, "std::uint64_t", "kStudioDoubles", doubles);
    std::fprintf(file, "}  // namespace halflit::raster\n");
    return std::fclose(file) == 0 ? 0 : 4;
}
