#include "apps/halflit/flags/completion.hpp"

#include "apps/halflit/flags/help_text.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

bool is_literal(const std::string& word) {
    return std::none_of(word.begin(), word.end(), [](char c) { return (c >= 'A' && c <= 'Z') || c == '.' || c == ','; });
}

/// The values of a form that are typed as they stand: "sky", "none" of "FILE|sky|none".
std::string literals(const std::string& form, const char* separator = " ") {
    std::vector<std::string> words = words_of(form, '|');
    std::erase_if(words, [](const std::string& word) { return !is_literal(word); });
    return joined(words, separator);
}

bool takes_file(const std::string& form) { return form.starts_with("FILE"); }
bool takes_folder(const std::string& form) { return form.starts_with("DIR"); }

std::string command_words(std::span<const Command> commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return joined(names, " ");
}

std::string flag_words(const Command& command) {
    std::vector<std::string> names = {"--help", "--help-all"};
    for (const Flag* flag : flags_of(command)) names.push_back(flag->long_name());
    return joined(names, " ");
}

std::string positional_words(const Command& command) {
    std::vector<std::string> forms;
    for (const Positional& positional : command.positionals) forms.push_back(literals(positional.form));
    return joined(forms, " ");
}

/// Text in single quotes for zsh and fish; `special` characters get a backslash.
std::string quoted(std::string_view text, std::string_view special) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) out += '\\';
        out += c == '\'' ? std::string("’") : std::string(1, c);  // an apostrophe would end the quotes
    }
    return out;
}

/// One pattern of bash's `case` for all flags of a command that take the same kind of value.
std::string bash_case(const Command& command, bool (*kind)(const std::string&), const std::string& action) {
    std::vector<std::string> patterns;
    for (const Flag* flag : flags_of(command))
        if (kind(flag->form))
            for (const std::string& name : words_of(flag->names, ',')) patterns.push_back(command.name + "\\ " + name);
    return patterns.empty() ? "" : "        " + joined(patterns, "|") + ") " + action + "; return ;;\n";
}

}  // namespace

std::string bash_completion(std::span<const Command> commands) {
    std::string values, flags;
    for (const Command& command : commands) {
        values += bash_case(command, takes_file, "COMPREPLY=($(compgen -f -- \"$word\"))");
        values += bash_case(command, takes_folder, "COMPREPLY=($(compgen -d -- \"$word\"))");
        for (const Flag* flag : flags_of(command))
            if (const std::string words = literals(flag->form); !words.empty() && !takes_file(flag->form))
                values += "        " + command.name + "\\ " + flag->long_name() + ") COMPREPLY=($(compgen -W \"" + words +
                          "\" -- \"$word\")); return ;;\n";
        flags += "        " + command.name + ") flags=\"" + flag_words(command) + "\" words=\"" + positional_words(command) + "\" ;;\n";
    }
    return "# bash completion of halflit; source it, or put it into the folder bash-completion/completions\n"
           "_halflit() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} flags= words=\n"
           "    if [[ $COMP_CWORD == 1 ]]; then\n"
           "        COMPREPLY=($(compgen -W \"" +
           command_words(commands) +
           " --help --version --self-test\" -- \"$word\") $(compgen -f -- \"$word\"))\n"
           "        return\n"
           "    fi\n"
           "    [[ \" " +
           command_words(commands) +
           " \" == *\" $command \"* ]] || command=render\n"
           "    case \"$command $before\" in\n" +
           values +
           "    esac\n"
           "    case \"$command\" in\n" +
           flags +
           "    esac\n"
           "    if [[ $word == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n"
           "    else\n"
           "        COMPREPLY=($(compgen -W \"$words\" -- \"$word\") $(compgen -f -- \"$word\"))\n"
           "    fi\n"
           "}\n"
           "complete -o filenames -F _halflit halflit\n";
}

std::string zsh_completion(std::span<const Command> commands) {
    std::string names, cases;
    for (const Command& command : commands) {
        names += "        '" + quoted(command.name + ":", "") + quoted(first_part(command.help), "\\:") + "'\n";
        cases += "        " + command.name + ") _arguments \\\n";
        for (const Flag* flag : flags_of(command)) {
            const auto spellings = words_of(flag->names, ',');
            const std::string name = spellings.size() > 1 ? "{" + joined(spellings, ",") + "}" : spellings[0];
            const std::string action = takes_file(flag->form)     ? "_files"
                                       : takes_folder(flag->form) ? "_files -/"
                                       : flag->form.empty()       ? ""
                                                                  : "(" + literals(flag->form) + ")";
            cases += "            " + std::string(flag->repeated ? "'*'" : "") + name + "'[" + quoted(first_part(flag->help), "\\[]:") +
                     "]" + (flag->form.empty() ? "" : ":" + quoted(flag->form, "\\:") + ":" + action) + "' \\\n";
        }
        cases += "            '*:argument:_files' ;;\n";
    }
    return "#compdef halflit\n"
           "_halflit() {\n"
           "    local -a commands=(\n" +
           names +
           "    )\n"
           "    if (( CURRENT == 2 )); then\n"
           "        _describe command commands\n"
           "        _files\n"
           "        return\n"
           "    fi\n"
           "    local command=$words[2]\n"
           "    [[ \" " +
           command_words(commands) +
           " \" == *\" $command \"* ]] || command=render\n"
           "    shift words\n"
           "    words[1]=$command\n"
           "    (( CURRENT-- ))\n"
           "    case $command in\n" +
           cases +
           "    esac\n"
           "}\n"
           "if [[ $funcstack[1] == _halflit ]]; then _halflit \"$@\"; else compdef _halflit halflit; fi\n";
}

std::string fish_completion(std::span<const Command> commands) {
    std::vector<std::string> others;  // without one of these, the command is render
    for (const Command& command : commands)
        if (command.name != "render") others.push_back(command.name);
    std::string text = "# fish completion of halflit\n";
    for (const Command& command : commands)
        text +=
            "complete -c halflit -n __fish_use_subcommand -a " + command.name + " -d '" + quoted(first_part(command.help), "\\") + "'\n";
    for (const Command& command : commands)
        for (const Flag* flag : flags_of(command)) {
            text += "complete -c halflit -n '" +
                    (command.name == "render" ? "not __fish_seen_subcommand_from " + joined(others, " ")
                                              : "__fish_seen_subcommand_from " + command.name) +
                    "'";
            for (const std::string& name : words_of(flag->names, ','))
                text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (takes_file(flag->form) || takes_folder(flag->form))
                text += " -rF";
            else if (!flag->form.empty())
                text += " -x";
            if (const std::string words = literals(flag->form); !words.empty()) text += " -a '" + words + "'";
            text += " -d '" + quoted(first_part(flag->help), "\\") + "'\n";
        }
    return text;
}

}  // namespace halflit::cli
