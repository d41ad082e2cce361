#include "bench/peer/flags.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <type_traits>

namespace halflit::peer {
namespace {

void usage(std::FILE* to) {
    std::fprintf(
        to,
        "usage: ./dev bench --peer [FLAGS]\n"
        "Frames of halflit against frames of Mesa's llvmpipe, in turn, of the same scenes; prints times, ratios and the difference\n"
        "of the pictures. bench/README.md says what is measured.\n"
        "  --scenes A,B..          scenes (default: all)\n"
        "  --threads N,M..         threads of both (default 1,2); each runs on as many processors\n"
        "  --samples N,M..         samples a pixel, 1 or 4 (default 1,4)\n"
        "  --rounds N              frames of each (default 20)\n"
        "  --seconds S             time for a scene, from the third round on (default 20)\n"
        "  --views N               views of each data set, in place of rounds and seconds (default 1000; 50 for a quick look)\n"
        "  --size WxH              size of the picture (default 1920x1080; data sets 256x256)\n"
        "  --textures rgba16|srgb8 llvmpipe's textures: halflit's texels (default), or rounded to 8 bits\n"
        "  --filter usual|fast     llvmpipe's filters: as they come (default), or with its shortcuts\n"
        "  --shader usual|special  llvmpipe's highlights: by pow (default), or their exponent 30 written as products\n"
        "  --clock wall|cpu        time that passes (default), or CPU time of all threads together\n"
        "  --no-first              leave out first frames and memory\n"
        "  --pictures DIR          write both pictures of each scene there\n"
        "  --glb DIR               write the scenes there as .glb, and draw nothing\n"
        "  --csv DIR               write tables there, named by processor and instruction set\n"
        "scenes:\n");
    for (const SceneEntry& entry : scene_entries())
        std::fprintf(to, "  %-14s %s\n", std::string(entry.name).c_str(), std::string(entry.content).c_str());
}

std::vector<std::string> parts(std::string_view text, char separator) {
    std::vector<std::string> all;
    while (true) {
        const std::size_t end = text.find(separator);
        all.emplace_back(text.substr(0, end));
        if (end == std::string_view::npos) return all;
        text.remove_prefix(end + 1);
    }
}

/// Whole numbers in [1, most]; empty if one is not.
std::vector<int> numbers(std::string_view text, char separator, int most) {
    std::vector<int> all;
    for (const std::string& part : parts(text, separator)) {
        char* end = nullptr;
        const long value = std::strtol(part.c_str(), &end, 10);
        if (part.empty() || *end != '\0' || value < 1 || value > most) return {};
        all.push_back(static_cast<int>(value));
    }
    return all;
}

bool known_scenes(const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [](const std::string& name) {
        const auto& all = scene_entries();
        return std::any_of(all.begin(), all.end(), [&](const SceneEntry& entry) { return entry.name == name; });
    });
}

/// False if the flag or its value is not understood.
bool read_flag(std::string_view flag, const std::string& value, Flags& flags) {
    const auto one_number = [&](int most, int& out) {
        const std::vector<int> values = numbers(value, ',', most);
        if (values.size() == 1) out = values[0];
        return values.size() == 1;
    };
    if (flag == "--scenes") return flags.scenes = parts(value, ','), known_scenes(flags.scenes);
    if (flag == "--threads") return flags.threads = numbers(value, ',', 1024), !flags.threads.empty();
    if (flag == "--samples") {
        flags.samples = numbers(value, ',', 4);
        return !flags.samples.empty() && std::all_of(flags.samples.begin(), flags.samples.end(), [](int n) { return n == 1 || n == 4; });
    }
    if (flag == "--rounds") return one_number(100000, flags.limits.rounds);
    if (flag == "--views") return one_number(100000, flags.limits.views);
    if (flag == "--seconds") {
        int seconds = 0;
        if (!one_number(100000, seconds)) return false;
        flags.limits.seconds = seconds;
        return true;
    }
    if (flag == "--size") {
        const std::vector<int> size = numbers(value, 'x', 8192);
        if (size.size() == 2) flags.limits.width = size[0], flags.limits.height = size[1];
        return size.size() == 2;
    }
    const auto one_of = [&](std::string_view usual, std::string_view other, auto& out) {
        using Value = std::remove_reference_t<decltype(out)>;
        if (value != usual && value != other) return false;
        out = static_cast<Value>(value == other ? 1 : 0);
        return true;
    };
    if (flag == "--textures") return one_of("rgba16", "srgb8", flags.storage);
    if (flag == "--filter") return one_of("usual", "fast", flags.filter);
    if (flag == "--shader") return one_of("usual", "special", flags.shader);
    if (flag == "--clock") return one_of("wall", "cpu", flags.limits.clock);
    if (flag == "--pictures") return flags.pictures = value, true;
    if (flag == "--glb") return flags.glb = value, true;
    if (flag == "--csv") return flags.csv = value, true;
    return false;
}

}  // namespace

std::optional<Flags> read_flags(int argc, char** argv, int& code) {
    Flags flags;
    for (const SceneEntry& entry : scene_entries()) flags.scenes.emplace_back(entry.name);
    for (int i = 1; i < argc; ++i) {
        const std::string_view flag = argv[i];
        if (flag == "--help" || flag == "-h") return usage(stdout), code = 0, std::nullopt;
        if (flag == "--no-first") {
            flags.first = false;
            continue;
        }
        const bool good = i + 1 < argc && read_flag(flag, argv[i + 1], flags);
        if (!good) {
            usage(stderr);
            std::fprintf(stderr, "peer bench: not understood: %s %s\n", argv[i], i + 1 < argc ? argv[i + 1] : "");
            return code = 2, std::nullopt;
        }
        ++i;
    }
    return flags;
}

}  // namespace halflit::peer
