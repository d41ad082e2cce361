#include "apps/halflit/flags/help_text.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr std::size_t kColumn = 30;  ///< column at which the explanations begin

/// Words of `text`, the first one at `column`, in lines of at most `width` columns; further lines are indented by `indent`.
std::string folded(std::string_view text, std::size_t column, std::size_t indent, std::size_t width) {
    std::string lines;
    for (const std::string& word : words_of(text, ' ')) {
        if (!lines.empty() && column + 1 + word.size() > width) {
            lines += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (!lines.empty()) {
            lines += ' ';
            ++column;
        }
        lines += word;
        column += word.size();
    }
    return lines + "\n";
}

/// A label with its explanation beside it, or below if the label is long.
std::string row(const std::string& label, const std::string& help, std::size_t width) {
    const bool beside = label.size() + 4 <= kColumn;
    const std::string start = "  " + label;
    return start + (beside ? std::string(kColumn - start.size(), ' ') : "\n" + std::string(kColumn, ' ')) +
           folded(help, kColumn, kColumn, width);
}

std::string group_rows(const FlagGroup& group, bool all, std::size_t width) {
    std::string rows;
    for (const Flag& flag : group.flags)
        if (all || !flag.advanced) rows += row(flag_label(flag), flag.help, width);
    return rows.empty() ? "" : "\n" + group.title + ":\n" + rows;
}

}  // namespace

std::string flag_label(const Flag& flag) {
    std::string label = flag.names;
    if (const std::size_t comma = label.find(','); comma != std::string::npos) label.insert(comma + 1, " ");
    return flag.form.empty() ? label : label + " " + flag.form;
}

std::string usage_line(const Command& command) {
    std::string line = "halflit " + command.name;
    if (!command.groups.empty()) line += " [FLAGS]";
    for (const Positional& positional : command.positionals) {
        const std::string name = !positional.usage.empty() ? positional.usage : positional.name + (positional.repeated ? "..." : "");
        line += positional.required ? " " + name : " [" + name + "]";
    }
    return line;
}

std::string program_help(std::span<const Command> commands, std::size_t width) {
    std::string text =
        std::string(kProgramHelp) + "\n\nUsage: halflit SCENE [PICTURE] [FLAGS]\n       halflit COMMAND [FLAGS]\n\nCommands:\n";
    for (const Command& command : commands)
        if (command.is_offered())
            text += "  " + command.name + std::string(12 - command.name.size(), ' ') + folded(command.help, 14, 14, width);
    text += "\nFlags:\n" + row("-h, --help", "Print this help", width) +
            row("-V, --version", "Print the version, with --verbose also those of the libraries in the program", width) +
            row("--self-test",
                "Draw small built-in scenes by every instruction set, and compare them with built-in hashes; for reports of faults", width);
    return text + "\n" +
           folded("'halflit model.glb' is 'halflit render model.glb'. Run 'halflit COMMAND --help' for the flags of a command.", 0, 0,
                  width) +
           folded(
               "'halflit man [COMMAND]' prints a manual page, 'halflit completion bash|zsh|fish' a script that completes the command line, "
               "'halflit flags' all flags.",
               0, 0, width) +
           folded(kExitCodesHelp, 0, 0, width);
}

std::string command_help(const Command& command, bool all, std::size_t width) {
    std::string text = folded(command.help, 0, 0, width) + "\nUsage: " + usage_line(command) + "\n";
    if (!command.positionals.empty()) text += "\nArguments:\n";
    for (const Positional& positional : command.positionals) text += row(positional.name, positional.help, width);
    for (const FlagGroup& group : command.groups) text += group_rows(group, all, width);
    const auto flags = flags_of(command);
    const bool more = !all && std::any_of(flags.begin(), flags.end(), [](const Flag* flag) { return flag->advanced; });
    text += "\nHelp:\n" + row("-h, --help", "Print this help", width);
    if (more) text += row("--help-all", "Print the rarely used flags too", width);
    return text;
}

}  // namespace halflit::cli
