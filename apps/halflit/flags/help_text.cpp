#include "apps/halflit/flags/help_text.hpp"

#include "sh/config.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr std::size_t kColumn = 30;  ///< column at which the explanations begin

const std::string kProgramExamples[] = {"halflit model.glb", "halflit part.stl part.png --view iso --size 800x600",
                                        "halflit look part.stl -o look.png --json look.json"};

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

/// A label that has its explanation beside it: of the values of a flag only as many as have room.
std::string short_label(const Flag& flag) {
    constexpr std::size_t kRoom = kColumn - 4;
    Flag shown = flag;
    std::vector<std::string> values = words_of(flag.form, '|');
    while (flag_label(shown).size() > kRoom && values.size() > 1) {
        values.pop_back();
        shown.form = joined(values, "|") + "|..";
    }
    return flag_label(shown);
}

std::string command_row(const Command& command, std::string_view help, std::size_t width) {
    constexpr std::size_t kCommandColumn = 14;
    return "  " + command.name + std::string(kCommandColumn - 2 - command.name.size(), ' ') +
           folded(help, kCommandColumn, kCommandColumn, width);
}

std::string usage_and_examples(const Command& command) {
    const std::string usage = "\nUsage: " + usage_line(command) + "\n";
    return command.examples.empty() ? usage : usage + "\nExamples:\n" + example_lines(command.examples, 2);
}

/// The page of a command with usual flags.
std::string usual_help(const Command& command, std::size_t width) {
    std::string text = usage_and_examples(command) + "\nArguments and usual flags:\n";
    for (const Positional& positional : command.positionals) text += row(positional.name, std::string(first_part(positional.help)), width);
    const std::vector<const Flag*> flags = flags_of(command);
    for (const std::string& name : command.usual) {
        const auto flag = std::find_if(flags.begin(), flags.end(), [&](const Flag* one) { return one->long_name() == name; });
        HALFLIT_ASSERT(flag != flags.end());
        text += row(short_label(**flag), std::string(first_part((*flag)->help)), width);
    }
    return text + "\nAll " + std::to_string(flags.size()) + " flags: halflit " + command.name + " --help-all\n";
}

}  // namespace

std::string_view first_part(std::string_view help) {
    std::size_t end = help.size();
    for (const char* mark : {"; ", ": ", ". ", " ("}) end = std::min(end, help.find(mark));
    return help.substr(0, end);
}

std::string example_lines(std::span<const std::string> examples, std::size_t indent) {
    std::string lines;
    for (const std::string& example : examples) lines += std::string(indent, ' ') + example + "\n";
    return lines;
}

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

std::string program_help(std::span<const Command> commands, bool all, std::size_t width) {
    std::string text = std::string(kProgramHelp) + "\n\nUsage: halflit SCENE [PICTURE] [FLAGS]\n       halflit COMMAND [FLAGS]\n";
    if (!all) text += "\nExamples:\n" + example_lines(kProgramExamples, 2);
    text += "\nCommands:\n";
    for (const Command& command : commands)
        if (command.is_offered() && (all || command.listed == Command::Listed::by_help))
            text += command_row(command, all ? std::string_view(command.help) : first_part(command.help), width);
    if (!all)
        return text + "\n" + folded("Usual flags of a command: halflit COMMAND --help", 0, 0, width) +
               folded("All commands, and flags of the program: halflit --help-all", 0, 0, width);
    text += "\nFlags:\n" + row("-h, --help", "Print the usual commands", width) + row("--help-all", "Print this help", width) +
            row("-V, --version", "Print the version, with --verbose also those of the libraries in the program", width) +
            row("--self-test",
                "Draw small built-in scenes by every instruction set, and compare them with built-in hashes; for reports of faults", width);
    return text + "\n" +
           folded(
               "'halflit model.glb' is 'halflit render model.glb'. Run 'halflit COMMAND --help' for the usual flags of a command, "
               "'halflit COMMAND --help-all' for all of them.",
               0, 0, width) +
           folded(
               "'halflit man [COMMAND]' prints a manual page, 'halflit completion bash|zsh|fish' a script that completes the command line, "
               "'halflit flags' all flags.",
               0, 0, width) +
           folded(kExitCodesHelp, 0, 0, width);
}

std::string command_help(const Command& command, bool all, std::size_t width) {
    std::string text = folded(command.help, 0, 0, width);
    if (!all && !command.usual.empty()) return text + usual_help(command, width);
    text += usage_and_examples(command);
    if (!command.positionals.empty()) text += "\nArguments:\n";
    for (const Positional& positional : command.positionals) text += row(positional.name, positional.help, width);
    for (const FlagGroup& group : command.groups) {
        text += "\n" + group.title + ":\n";
        for (const Flag& flag : group.flags) text += row(flag_label(flag), flag.help, width);
    }
    text += "\nHelp:\n" + row("-h, --help", command.usual.empty() ? "Print this help" : "Print the usual flags", width);
    if (!command.usual.empty()) text += row("--help-all", "Print this help", width);
    return text;
}

}  // namespace halflit::cli
