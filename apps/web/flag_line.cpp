// The flags of a picture by the command line's own tables, without CLI11: each flag by one of its names, its value as the next word or
// behind '='.
#include "apps/halflit/flags/command_line.hpp"
#include "apps/halflit/program/spelling.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

const Flag* find_flag(std::span<const Flag* const> flags, const std::string& name) {
    for (const Flag* const flag : flags) {
        const std::vector<std::string> names = words_of(flag->names, ',');
        if (std::find(names.begin(), names.end(), name) != names.end()) return flag;
    }
    return nullptr;
}

tl::unexpected<Error> unknown_flag(std::span<const Flag* const> flags, const std::string& name) {
    std::vector<std::string> names;
    for (const Flag* const flag : flags) names.push_back(flag->long_name());
    return fail(ErrorCode::usage, "unknown flag " + name + did_you_mean(name, names));
}

}  // namespace

Result<ParsedLine> parse_command_line(std::span<const Command> commands, std::vector<std::string> arguments) {
    const Command& command = commands[0];
    const std::vector<const Flag*> flags = flags_of(command);
    for (std::size_t i = 1; i < arguments.size(); ++i) {  // after the command's name
        const std::string& word = arguments[i];
        const std::size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
        const std::string name = word.substr(0, equals);
        const Flag* const flag = find_flag(flags, name);
        if (flag == nullptr) return unknown_flag(flags, name);
        const bool takes_value = !flag->form.empty(), assigned = equals != std::string::npos;
        if (assigned && !takes_value) return fail(ErrorCode::usage, name + ": takes no value");
        if (takes_value && !assigned && i + 1 == arguments.size()) return fail(ErrorCode::usage, name + ": expected a value");
        const std::string value = !takes_value ? "" : assigned ? word.substr(equals + 1) : arguments[++i];
        if (const auto read = flag->read(value); !read) return fail(ErrorCode::usage, name + ": " + read.error().message);
    }
    return ParsedLine{&command, ParsedLine::Wanted::run};
}

}  // namespace halflit::cli
