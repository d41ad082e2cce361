// Commands that print the tables: help, man, completion, flags.
#include "apps/engine/answers/answer_schema.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/flags/agent_pages.hpp"
#include "apps/halflit/flags/completion.hpp"
#include "apps/halflit/flags/help_text.hpp"
#include "apps/halflit/flags/manual.hpp"
#include "apps/halflit/mcp/server.hpp"
#include "apps/halflit/program/terminal.hpp"
#include "apps/halflit/program/text_file.hpp"

#include <algorithm>
#include <memory>

namespace halflit::cli {
namespace {

Result<int> print(const std::string& text) {
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return 0;
}

/// The command of this name; null for an empty name.
Result<const Command*> command_named(const std::vector<Command>& commands, const std::string& name) {
    if (name.empty()) return nullptr;
    std::vector<std::string> names;
    for (const Command& command : commands) {
        if (command.name == name) return &command;
        if (command.is_offered()) names.push_back(command.name);
    }
    return fail(ErrorCode::usage, "COMMAND: expected one of " + joined(names, ", ") + ", found '" + name + "'" + did_you_mean(name, names));
}

/// A command with one optional argument, which names a command.
Command about_commands(const char* name, const char* help, std::function<std::string(const std::vector<Command>&, const Command*)> text) {
    const auto chosen = std::make_shared<std::string>();
    const auto run = [chosen, text = std::move(text)]() -> Result<int> {
        const std::vector<Command> commands = all_commands();
        const auto command = command_named(commands, *chosen);
        if (!command) return tl::unexpected(command.error());
        return print(text(commands, *command));
    };
    return {name, help, {{.name = "COMMAND", .help = "One of the commands", .read = read_text(*chosen)}}, {}, run, Command::Listed::never};
}

}  // namespace

Command help_command() {
    return about_commands("help", "Print the help of the program or of a command", [](const auto& commands, const Command* command) {
        return command == nullptr ? program_help(commands, false, help_width()) : command_help(*command, false, help_width());
    });
}

Command man_command() {
    return about_commands("man", "Print the manual page of the program or of a command", [](const auto& commands, const Command* command) {
        return command == nullptr ? program_manual(commands) : command_manual(*command);
    });
}

Command completion_command() {
    const auto shell = std::make_shared<std::string>();
    const auto run = [shell]() -> Result<int> {
        const std::vector<Command> commands = all_commands();
        if (*shell == "bash") return print(bash_completion(commands));
        if (*shell == "zsh") return print(zsh_completion(commands));
        if (*shell == "fish") return print(fish_completion(commands));
        return fail(ErrorCode::usage, "SHELL: expected bash, zsh or fish, found '" + *shell + "'");
    };
    return {"completion",
            "Print a script that completes commands, flags and values in a shell",
            {{.name = "SHELL", .help = "bash, zsh or fish", .read = read_text(*shell), .required = true, .form = "bash|zsh|fish"}},
            {},
            run,
            Command::Listed::never};
}

Command flags_command() {
    struct Pages {
        bool markdown = false, skill = false, llms = false;
        std::string schema;
    };
    const auto wanted = std::make_shared<Pages>();
    return {"flags",
            "Print all commands and flags",
            {},
            {{"Flags",
              {{"--markdown", "", "As a page in Markdown", set_to(wanted->markdown)},
               {"--skill", "", "The page for agents that use the program", set_to(wanted->skill)},
               {"--llms", "", "The index of the documentation, llms.txt", set_to(wanted->llms)},
               {"--schema", joined(answer_kinds(), "|"), "The JSON Schema of a report", read_text(wanted->schema)}}}},
            [wanted]() -> Result<int> {
                if (!wanted->schema.empty()) {
                    const auto schema = answer_schema(wanted->schema);
                    if (!schema) return fail(ErrorCode::usage, "--schema: " + schema.error().message);
                    return print(*schema);
                }
                const std::vector<Command> commands = all_commands();
                if (wanted->markdown) return print(markdown_page(commands));
                if (wanted->skill) return print(skill_page(commands, tool_helps()));
                if (wanted->llms) return print(llms_page(commands));
                std::string text;
                for (const Command& command : commands)
                    if (!command.is_hidden()) text += (text.empty() ? "" : "\n") + command_help(command, true, help_width());
                return print(text);
            },
            Command::Listed::never};
}

}  // namespace halflit::cli
