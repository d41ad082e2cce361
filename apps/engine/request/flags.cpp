#include "apps/engine/request/flags.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/values.hpp"

#include <algorithm>
#include <iterator>

namespace halflit::engine {

ReadValue read_int(int& target, int min, int max) {
    return [&target, min, max](const std::string& text) -> Result<void> {
        const auto value = parse_int(text, min, max);
        if (!value) return tl::unexpected(value.error());
        target = static_cast<int>(*value);
        return {};
    };
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

namespace {

struct Found {
    const Flag* flag = nullptr;
    const FlagGroup* group = nullptr;
};

Found find_flag(const std::vector<FlagGroup>& groups, const std::string& name) {
    for (const FlagGroup& group : groups)
        for (const Flag& flag : group.flags) {
            const std::vector<std::string> names = words_of(flag.names, ',');
            if (std::find(names.begin(), names.end(), name) != names.end()) return {&flag, &group};
        }
    return {};
}

}  // namespace

Result<StageLines> read_flags(const std::vector<FlagGroup>& groups, std::span<const std::string> words) {
    StageLines lines;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
        const std::string name = word.substr(0, equals);
        const auto [flag, group] = find_flag(groups, name);
        if (flag == nullptr) {
            std::vector<std::string> names;
            for (const FlagGroup& one_group : groups)
                for (const Flag& one : one_group.flags) names.push_back(one.long_name());
            return fail(ErrorCode::usage, "unknown flag " + name + did_you_mean(name, names));
        }
        const bool takes_value = !flag->form.empty(), assigned = equals != std::string::npos;
        if (assigned && !takes_value) return fail(ErrorCode::usage, name + ": takes no value");
        const bool has_value = assigned || i + 1 < words.size();
        const std::string value = !takes_value || !has_value ? "" : assigned ? word.substr(equals + 1) : words[++i];
        if (takes_value && value.empty()) return fail(ErrorCode::usage, name + ": expected a value, found nothing");
        if (const auto read = flag->read(value); !read) return fail(ErrorCode::usage, name + ": " + read.error().message);
        lines[static_cast<std::size_t>(flag->stage.value_or(group->stage))] += flag->long_name() + "\n" + value + "\n";
    }
    return lines;
}

bool takes_number(const Flag& flag) {
    constexpr std::string_view kNumbers[] = {"N", "DEG", "PX", "PIXELS", "SECONDS", "CODES", "X",    "W",
                                             "S", "R",   "D",  "EV",     "OPACITY", "MIB",   "INDEX"};
    const std::vector<std::string> words = words_of(flag.form, '|');
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return word.find("..") != std::string::npos || std::find(std::begin(kNumbers), std::end(kNumbers), word) != std::end(kNumbers);
    });
}

void remove_flags(std::vector<FlagGroup>& groups, std::span<const std::string_view> long_names) {
    const auto removed = [&](const Flag& flag) {
        return std::find(long_names.begin(), long_names.end(), flag.long_name()) != long_names.end();
    };
    for (FlagGroup& group : groups) std::erase_if(group.flags, removed);
    std::erase_if(groups, [](const FlagGroup& group) { return group.flags.empty(); });
}

void tell_default(std::vector<FlagGroup>& groups, std::string_view name, const std::string& usual, const std::string& own) {
    const std::string text = "(default " + usual + ")";
    for (FlagGroup& group : groups)
        for (Flag& flag : group.flags)
            if (const std::size_t at = flag.help.find(text); flag.names == name && at != std::string::npos)
                flag.help.replace(at, text.size(), "(default " + own + ")");
}

}  // namespace halflit::engine
