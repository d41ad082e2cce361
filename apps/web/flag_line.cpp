// The flags of a picture by the command line's own tables, without CLI11: the page writes each flag by its long name and each value as a
// word of its own.
#include "apps/halflit/flags/command_line.hpp"

#include <algorithm>

namespace halflit::cli {

Result<ParsedLine> parse_command_line(std::span<const Command> commands, std::vector<std::string> arguments) {
    const Command& command = commands[0];
    const std::vector<const Flag*> flags = flags_of(command);
    for (std::size_t i = 1; i < arguments.size(); ++i) {  // after the command's name
        const std::string& name = arguments[i];
        const auto found = std::find_if(flags.begin(), flags.end(), [&](const Flag* flag) { return flag->long_name() == name; });
        if (found == flags.end()) return fail(ErrorCode::usage, name + ": unknown flag");
        const bool takes_value = !(*found)->form.empty();
        if (takes_value && i + 1 == arguments.size()) return fail(ErrorCode::usage, name + ": expected a value");
        if (const auto read = (*found)->read(takes_value ? arguments[++i] : ""); !read)
            return fail(ErrorCode::usage, name + ": " + read.error().message);
    }
    return ParsedLine{&command, ParsedLine::Wanted::run};
}

}  // namespace halflit::cli
