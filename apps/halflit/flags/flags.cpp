#include "apps/halflit/flags/flags.hpp"

#include "apps/halflit/flags/values.hpp"
#include "apps/halflit/program/messages.hpp"

#include <algorithm>

namespace halflit::cli {

ReadValue read_int(int& target, int min, int max) {
    return [&target, min, max](const std::string& text) -> Result<void> {
        const auto value = parse_int(text, min, max);
        if (!value) return tl::unexpected(value.error());
        target = static_cast<int>(*value);
        return {};
    };
}

std::vector<Flag> message_flags() {
    const auto choose = [](Verbosity chosen) -> ReadValue {
        return [chosen](const std::string&) -> Result<void> {
            set_verbosity(chosen);
            return {};
        };
    };
    return {{"-v,--verbose", "", "Also say what was chosen and how long each step took", choose(Verbosity::verbose)},
            {"-q,--quiet", "", "Print errors alone, no warnings, notes or progress", choose(Verbosity::quiet)}};
}

std::vector<std::string> words_of(std::string_view text, char separator) {
    std::vector<std::string> words;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        words.emplace_back(text.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string text;
    for (const std::string& word : words) text.append(text.empty() ? "" : separator).append(word);
    return text;
}

std::vector<const Flag*> flags_of(const Command& command) {
    std::vector<const Flag*> flags;
    for (const FlagGroup& group : command.groups)
        for (const Flag& flag : group.flags) flags.push_back(&flag);
    return flags;
}

void remove_flags(std::vector<FlagGroup>& groups, std::span<const std::string_view> long_names) {
    const auto removed = [&](const Flag& flag) {
        return std::find(long_names.begin(), long_names.end(), flag.long_name()) != long_names.end();
    };
    for (FlagGroup& group : groups) std::erase_if(group.flags, removed);
    std::erase_if(groups, [](const FlagGroup& group) { return group.flags.empty(); });
}

}  // namespace halflit::cli
