#include "apps/halflit/flags/manual.hpp"

#include "apps/halflit/flags/help_text.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

/// Text that roff prints as it is.
std::string roff(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string heading(const std::string& title) { return ".SH \"" + roff(title) + "\"\n"; }

/// A label, and below it an indented explanation.
std::string item(const std::string& label, const std::string& help) { return ".TP\n.B " + roff(label) + "\n" + roff(help) + "\n"; }

std::string page_head(const std::string& name, const std::string& help) {
    std::string upper = name;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return ".TH " + roff(upper) + " 1\n" + heading("NAME") + roff(name) + " \\- " + roff(help) + "\n" + heading("SYNOPSIS");
}

/// Text that Markdown prints as it is, in a cell of a table.
std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|' || c == '<' || c == '*' || c == '_') out += '\\';
        out += c;
    }
    return out;
}

/// In a cell, a '|' would end it even between backquotes.
std::string code_cell(const std::string& text) {
    std::string out = "`";
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out + "`";
}

/// Groups that an earlier command has in the same way are named by a link to it.
std::string markdown_groups(const Command& command, std::span<const Command> earlier) {
    std::string text, linked;
    for (const FlagGroup& group : command.groups) {
        const auto same = [&](const Command& other) {
            return std::any_of(other.groups.begin(), other.groups.end(), [&](const FlagGroup& g) {
                return g.title == group.title && g.flags.size() == group.flags.size() && command.name != other.name && g.title != "Flags" &&
                       std::equal(g.flags.begin(), g.flags.end(), group.flags.begin(),
                                  [](const Flag& a, const Flag& b) { return a.names == b.names && a.help == b.help; });
            });
        };
        const auto first = std::find_if(earlier.begin(), earlier.end(), same);
        if (first != earlier.end()) {
            linked += (linked.empty() ? "" : ", ") + group.title.substr(0, group.title.find(" ("));
            continue;
        }
        text += "\n" + group.title + "\n\n| flag | |\n|---|---|\n";
        for (const Flag& flag : group.flags) text += markdown_row(flag_label(flag), flag.help);
    }
    if (!linked.empty()) text = "\nAs [render](#halflit-render): " + linked + ".\n" + text;
    return text;
}

}  // namespace

std::string markdown_row(const std::string& label, const std::string& help) {
    return "| " + code_cell(label) + " | " + cell(help) + " |\n";
}

std::string program_manual(std::span<const Command> commands) {
    std::string text = page_head("halflit", kProgramHelp) + ".B halflit\n" + roff("COMMAND [FLAGS]") + "\n.br\n.B halflit\n" +
                       roff("SCENE [PICTURE] [FLAGS]") + "\n" + heading("COMMANDS");
    for (const Command& command : commands)
        if (!command.is_hidden()) text += item(command.name, command.help + ". See halflit-" + command.name + "(1).");
    return text + heading("EXIT STATUS") + roff(kExitCodesHelp) + "\n";
}

std::string command_manual(const Command& command) {
    std::string text = page_head("halflit-" + command.name, command.help) + ".B " + roff(usage_line(command)) + "\n";
    if (!command.positionals.empty()) text += heading("ARGUMENTS");
    for (const Positional& positional : command.positionals) text += item(positional.name, positional.help);
    for (const FlagGroup& group : command.groups) {
        text += heading(group.title);
        for (const Flag& flag : group.flags) text += item(flag_label(flag), flag.help);
    }
    if (!command.examples.empty()) text += heading("EXAMPLES") + ".nf\n" + roff(example_lines(command.examples, 0)) + ".fi\n";
    return text + heading("EXIT STATUS") + roff(kExitCodesHelp) + "\n" + heading("SEE ALSO") + "halflit(1)\n";
}

std::string markdown_page(std::span<const Command> commands) {
    std::string text = std::string("# Commands and flags\n\n") + kProgramHelp +
                       "\n\nThis page is the output of `halflit flags --markdown`; a test compares the two.\n\n" + kExitCodesHelp + "\n";
    for (std::size_t i = 0; i < commands.size(); ++i) {
        const Command& command = commands[i];
        if (command.is_hidden()) continue;
        text += "\n## halflit " + command.name + "\n\n" + command.help + ".\n\n    " + usage_line(command) + "\n";
        if (!command.examples.empty()) text += "\nExamples:\n\n" + example_lines(command.examples, 4);
        if (!command.positionals.empty()) text += "\n| argument | |\n|---|---|\n";
        for (const Positional& positional : command.positionals) text += markdown_row(positional.name, positional.help);
        text += markdown_groups(command, commands.first(std::min<std::size_t>(i, 1)));
    }
    return text;
}

}  // namespace halflit::cli
