// Runs a target on files, without libFuzzer: those that a fuzzer once found, and seeds with simple mutations of them.
//   halflit_fuzz_replay TARGET [--mutations N] [--seed S] FILE|FOLDER...
#include "tests/fuzz/target.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace halflit::fuzz;

namespace {

constexpr const FuzzTarget* kTargets[] = {&kGltfText, &kGlb, &kModel, &kPicture, &kKtx2, &kHdr, &kScene, &kCApi};

Random& mutations() {
    static Random random(1);
    return random;
}

Bytes read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void replay(const FuzzTarget& target, const std::filesystem::path& path, int times) {
    const Bytes input = read(path);
    std::printf("%s: %zu bytes\n", path.c_str(), input.size());
    std::fflush(stdout);  // the last line names the file that ends the program
    target.run(input);
    Bytes mutated = input;
    for (int i = 0; i < times; ++i) {
        if (i % 8 == 0) mutated = input;
        if (target.mutate == nullptr)
            mutate_bytes(mutated, target.max_bytes);
        else
            target.mutate(mutated, target.max_bytes, mutations());
        if (mutated.size() > target.max_bytes) mutated.resize(target.max_bytes);
        target.run(mutated);
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
    Random& random = mutations();
    if (size == 0) {
        if (max_size > 0) data[0] = static_cast<std::uint8_t>(random.next());
        return max_size > 0 ? 1 : 0;
    }
    const std::size_t at = random.below(size);
    switch (random.below(4)) {
        case 0:
            data[at] = static_cast<std::uint8_t>(random.next());
            return size;
        case 1:
            data[at] ^= static_cast<std::uint8_t>(1u << random.below(8));
            return size;
        case 2:
            std::memmove(data + at, data + at + 1, size - at - 1);
            return size - 1;
        default:
            if (size == max_size) return size;
            std::memmove(data + at + 1, data + at, size - at);
            return size + 1;
    }
}

int main(int argc, char** argv) {
    const auto* const found = std::find_if(std::begin(kTargets), std::end(kTargets),
                                           [&](const FuzzTarget* target) { return argc > 1 && std::strcmp(target->name, argv[1]) == 0; });
    if (found == std::end(kTargets)) {
        std::fprintf(stderr, "usage: halflit_fuzz_replay TARGET [--mutations N] [--seed S] FILE|FOLDER...\ntargets:");
        for (const FuzzTarget* target : kTargets) std::fprintf(stderr, " %s", target->name);
        std::fprintf(stderr, "\n");
        return 2;
    }
    int times = 0, files = 0;
    for (int i = 2; i < argc; ++i) {
        if (std::strcmp(argv[i], "--mutations") == 0 && i + 1 < argc) {
            times = std::atoi(argv[++i]);
            continue;
        }
        if (std::strcmp(argv[i], "--seed") == 0 && i + 1 < argc) {
            mutations() = Random(std::strtoull(argv[++i], nullptr, 10));
            continue;
        }
        std::vector<std::filesystem::path> paths;
        if (std::filesystem::is_directory(argv[i])) {
            for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
                if (entry.is_regular_file()) paths.push_back(entry.path());
            std::sort(paths.begin(), paths.end());
        } else {
            paths.emplace_back(argv[i]);
        }
        for (const std::filesystem::path& path : paths) {
            replay(**found, path, times);
            ++files;
        }
    }
    std::printf("%s: %d files\n", argv[1], files);
    return files > 0 ? 0 : 1;
}
