// Loads the files that make_files.py lists, and compares what is said with what must be.
//   halflit_gltf_rules LIST valid|seen|unseen
#include "halflit/gltf.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == at)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

bool in_a_name(char c) { return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Whether `words` stand in the text, and not as part of a longer name or path.
bool says(std::string_view text, std::string_view words) {
    for (std::size_t at = text.find(words); at != std::string_view::npos; at = text.find(words, at + 1)) {
        const std::size_t end = at + words.size();
        const bool begins = words.empty() || at == 0 || !(in_a_name(text[at - 1]) || text[at - 1] == '.');
        if (begins && (words.empty() || end == text.size() || !in_a_name(text[end]) || !in_a_name(words.back()))) return true;
    }
    return false;
}

struct Line {
    std::string file, kind, name, words;
    std::vector<std::string> allowed;
};

/// The fault, or nothing.
std::string fault_of(const Line& line) {
    halflit::LoadOptions as_stored;  // the rules' extreme numbers are far away, which is another warning
    as_stored.recentre = false;
    as_stored.strict = true;
    const auto loaded = halflit::load_gltf(line.file, as_stored);
    if (!loaded) {
        const std::string& message = loaded.error().message;
        if (line.kind != "seen") return "refused: " + message;
        if (loaded.error().code != halflit::ErrorCode::bad_input) return "refused, but not for bad input: " + message;
        return says(message, line.words) ? "" : "refused, but not at " + line.words + ": " + message;
    }
    std::string all;
    for (const std::string& warning : loaded->warnings) {
        all += "\n        " + warning;
        if (line.kind == "valid" && std::none_of(line.allowed.begin(), line.allowed.end(), [&](const std::string& words) {
                return !words.empty() && warning.find(words) != std::string::npos;
            }))
            return "warned of: " + warning;
        if (std::count(loaded->warnings.begin(), loaded->warnings.end(), warning) > 1) return "warned of twice: " + warning;
    }
    if (line.kind != "seen") return "";
    const bool said = std::any_of(loaded->warnings.begin(), loaded->warnings.end(),
                                  [&](const std::string& warning) { return says(warning, line.words); });
    return said ? "" : "nothing is said of " + line.words + ", but" + (all.empty() ? " nothing at all" : all);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("usage: halflit_gltf_rules LIST valid|seen|unseen\n", stderr), 2;
    std::ifstream list(argv[1]);
    int files = 0, faults = 0;
    for (std::string text; std::getline(list, text);) {
        const std::vector<std::string> fields = split(text, '\t');
        if (fields.size() != 5 || fields[1] != argv[2]) continue;
        const Line line{fields[0], fields[1], fields[2], fields[3], split(fields[4], '|')};
        ++files;
        if (const std::string fault = fault_of(line); !fault.empty()) {
            ++faults;
            std::printf("%s\n    %s\n    %s\n", line.name.c_str(), line.file.c_str(), fault.c_str());
        }
    }
    std::printf("%d files, %d faults\n", files, faults);
    return files > 0 && faults == 0 ? 0 : 1;
}
