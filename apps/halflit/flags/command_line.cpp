// The only source that includes CLI11, which takes seconds to compile.
#include "apps/halflit/flags/command_line.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/spelling.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>
#include <utility>

namespace halflit::cli {
namespace {

void read_or_throw(const std::string& name, const ReadValue& read, const std::string& text) {
    const Result<void> result = read(text);
    if (!result) throw CLI::ValidationError(name, result.error().message);
}

/// Reads every text by the flag's own function.
auto reader(const std::string& name, const ReadValue& read) {
    return [name, &read](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) read_or_throw(name, read, text);
    };
}

void add_flag(CLI::App& app, const Flag& flag) {
    const std::string name = flag.long_name();
    if (flag.form.empty())
        app.add_flag_callback(flag.names, [name, &flag] { read_or_throw(name, flag.read, ""); });
    else if (flag.repeated)
        app.add_option_function<std::vector<std::string>>(flag.names, reader(name, flag.read))
            ->allow_extra_args(false)
            ->type_name(flag.form);
    else
        app.add_option_function<std::string>(flag.names, [name, &flag](const std::string& text) { read_or_throw(name, flag.read, text); })
            ->type_name(flag.form);
}

void add_positional(CLI::App& app, const Positional& positional) {
    const std::string& name = positional.name;
    CLI::Option* option = positional.repeated ? app.add_option_function<std::vector<std::string>>(name, reader(name, positional.read))
                                              : app.add_option_function<std::string>(name, [&positional](const std::string& text) {
                                                    read_or_throw(positional.name, positional.read, text);
                                                });
    option->required(positional.required);
}

/// True if an argument may be or hold the flag: by its long name, or among letters behind one dash.
bool may_name(const std::vector<std::string>& arguments, const Flag& flag) {
    for (const std::string& name : words_of(flag.names, ','))
        for (const std::string& argument : arguments) {
            const bool is_long = name.starts_with("--");
            if (is_long ? argument.starts_with(name) : argument.starts_with('-') && argument.find(name[1], 1) != std::string::npos)
                return true;
        }
    return false;
}

/// Only what the line names is told to CLI11, which takes 2 ms for all flags of all commands.
void add_command(CLI::App& root, const Command& command, const std::vector<std::string>& arguments) {
    CLI::App* app = root.add_subcommand(command.name, command.help);
    if (std::find(arguments.begin(), arguments.end(), command.name) == arguments.end()) return;
    for (const Positional& positional : command.positionals) add_positional(*app, positional);
    for (const FlagGroup& group : command.groups)
        for (const Flag& flag : group.flags)
            if (may_name(arguments, flag)) add_flag(*app, flag);
}

/// Words of other programs, with those that mean the same here.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"--resolution", "--size"},
    {"--width", "--size"},
    {"--height", "--size"},
    {"--bg", "--background"},
    {"--bg-color", "--background"},
    {"--background-color", "--background"},
    {"--transparent", "--background"},
    {"--no-background", "--background"},
    {"--out", "--output"},
    {"--wireframe", "--edges"},
    {"--orthographic", "--ortho"},
    {"--hdri", "--env"},
    {"--hdri-file", "--env"},
    {"--environment", "--env"},
    {"--skybox", "--env"},
    {"--msaa", "--samples"},
    {"--antialiasing", "--samples"},
    {"--spp", "--samples"},
    {"--anti-aliasing", "--samples"},
    {"--camera-view-angle", "--fov"},
    {"--camera-zoom-factor", "--zoom"},
    {"--camera-azimuth-angle", "--azimuth"},
    {"--camera-elevation-angle", "--elevation"},
    {"--camera-index", "--camera"},
    {"--jobs", "--threads"},
    {"convert", "render"},
    {"draw", "render"},
    {"inspect", "info"},
    {"validate", "info"},
    {"benchmark", "bench"},
};

/// " (did you mean WORD?)": the candidate that is spelled alike, or has a synonym that is.
std::string meant_by(const std::string& word, const std::vector<std::string>& candidates) {
    std::vector<std::string> known = candidates;
    for (const auto& [other, ours] : kSynonyms)
        if (std::find(candidates.begin(), candidates.end(), ours) != candidates.end()) known.emplace_back(other);
    const std::string meant = nearest(word, known);
    const auto* const synonym =
        std::find_if(std::begin(kSynonyms), std::end(kSynonyms), [&](const auto& row) { return row.first == meant; });
    return meant.empty() ? "" : " (did you mean " + (synonym != std::end(kSynonyms) ? std::string(synonym->second) : meant) + "?)";
}

std::vector<std::string> command_names(std::span<const Command> commands) {
    std::vector<std::string> names;
    for (const Command& command : commands)
        if (command.is_offered()) names.push_back(command.name);
    return names;
}

/// Words that may come first: commands, built-in scenes, and the models in this folder.
std::vector<std::string> known_words(std::span<const Command> commands) {
    std::vector<std::string> words = command_names(commands);
    words.insert(words.end(), {"help", "demo", "sphere:N", "lights:N", "--version", "--self-test"});
    for (std::string& file : files_beside(""))
        if (is_model_name(file)) words.push_back(std::move(file));
    return words;
}

/// Flags of a command. Without one, those of the program and of render, which is meant by a line that begins with a scene.
std::vector<std::string> flag_names(const Command* command, std::span<const Command> commands) {
    std::vector<std::string> names = {"--help", "--help-all"};
    if (command == nullptr) names.insert(names.end(), {"--version", "--self-test"});
    for (const Flag* flag : flags_of(command != nullptr ? *command : commands.front())) names.push_back(flag->long_name());
    return names;
}

/// The parser's message in the words of the others: a flag given too often or without its value, a word that is missing.
std::string in_plain_words(std::string message, const Command* command) {
    constexpr std::string_view kTwice = ": At Most 1 required but received ", kNothing = ": 1 required ", kMissing = " missing",
                               kWord = " is required";
    if (const std::size_t at = message.find(kTwice); at != std::string::npos)
        return message.substr(0, at) + ": expected once, found " + message.substr(at + kTwice.size()) + " times";
    if (const std::size_t at = message.find(kNothing); at != std::string::npos && message.ends_with(kMissing)) {
        message.resize(message.size() - kMissing.size());
        return message.substr(0, at) + ": expected " + message.substr(at + kNothing.size()) + " after it, found nothing";
    }
    if (command == nullptr || !message.ends_with(kWord)) return message;
    const std::string name = message.substr(0, message.size() - kWord.size());
    for (const Positional& positional : command->positionals)
        if (positional.name == name) return "expected " + name + ", found nothing: " + positional.help;
    return message;
}

/// One line for a wrong command line. `command`: the command that was given; null if there is none.
std::string usage_message(const CLI::App& root, const CLI::ParseError& error, std::span<const Command> commands, const Command* command) {
    std::string message = in_plain_words(error.what(), command);
    const std::vector<std::string> rest = root.remaining(true);
    const bool no_command = command == nullptr && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError);
    if (!rest.empty() && (no_command || error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))) {
        const std::string& word = rest[0];
        const std::string name = word.substr(0, word.find('='));
        const std::vector<std::string> flags = flag_names(command, commands);
        if (word.starts_with("-") && std::find(flags.begin(), flags.end(), name) != flags.end())
            message = command != nullptr ? word + " stands before the command: expected halflit " + command->name + " " + word
                                         : word + ": no scene and no command: expected halflit SCENE [PICTURE] " + word;
        else if (word.starts_with("-"))
            message = "unknown flag " + word + meant_by(name, flags);
        else if (command == nullptr && word.find_first_of("./") != std::string::npos)
            message = word + ": no such scene" + meant_by(name, known_words(commands));
        else if (command == nullptr)
            message = "unknown command " + word + meant_by(name, known_words(commands));
        else
            message = "unexpected argument " + word;
    } else if (no_command) {
        message = "no scene and no command: expected halflit SCENE [PICTURE], or one of";
        for (const std::string& name : command_names(commands)) message += " " + name;
    }
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message + "; see halflit " + (command != nullptr ? command->name + " " : "") + "--help";
}

/// An empty argument comes from a variable that is not set: what it was to name would be chosen by default instead.
Result<void> refuse_empty(const std::vector<std::string>& arguments) {
    std::string flag;  // the one before
    for (const std::string& argument : arguments) {
        const bool assigns_nothing = argument.starts_with("--") && argument.ends_with('=');
        if (argument.empty() || assigns_nothing) {
            const std::string of = assigns_nothing ? argument.substr(0, argument.size() - 1) : flag;
            return fail(ErrorCode::usage,
                        (of.empty() ? "an empty argument" : of) + ": expected a value, found nothing (an empty variable?)");
        }
        flag = argument.starts_with('-') ? argument : "";
    }
    return {};
}

/// Where --json is a switch, a "-" after it says what the switch does in any case: print. It is left out if the line has another word for
/// each place; otherwise it is that word, as standard input.
void drop_dash_of_json(std::span<const Command> commands, std::vector<std::string>& arguments) {
    const auto begin = std::find_if(arguments.begin(), arguments.end(), [](const std::string& word) { return !word.starts_with('-'); });
    const auto command =
        std::find_if(commands.begin(), commands.end(), [&](const Command& one) { return begin != arguments.end() && one.name == *begin; });
    if (command == commands.end() || (!command->positionals.empty() && command->positionals.back().repeated)) return;
    const std::vector<const Flag*> flags = flags_of(*command);
    const auto flag_of = [&](const std::string& word) -> const Flag* {
        for (const Flag* const flag : flags)
            for (const std::string& name : words_of(flag->names, ','))
                if (name == word) return flag;
        return nullptr;
    };
    auto dash = arguments.end();
    std::size_t words = 0;
    for (auto word = begin + 1; word != arguments.end(); ++word) {
        const Flag* const flag = flag_of(*word);
        if (flag != nullptr && !flag->form.empty() && word + 1 != arguments.end()) ++word;
        if (flag != nullptr || (word->starts_with('-') && *word != "-")) continue;
        ++words;
        if (*word == "-" && *(word - 1) == "--json") dash = word;
    }
    if (dash != arguments.end() && words > command->positionals.size()) arguments.erase(dash);
}

/// --verbose beside --version, which is not of a command. It is left out of the line.
bool root_is_verbose(std::vector<std::string>& arguments) {
    const auto is_version = [](const std::string& word) { return word == "--version" || word == "-V"; };
    return std::any_of(arguments.begin(), arguments.end(), is_version) &&
           std::erase_if(arguments, [](const std::string& word) { return word == "--verbose" || word == "-v"; }) > 0;
}

}  // namespace

Result<ParsedLine> parse_command_line(std::span<const Command> commands, std::vector<std::string> arguments) {
    if (const auto checked = refuse_empty(arguments); !checked) return tl::unexpected(checked.error());
    drop_dash_of_json(commands, arguments);
    CLI::App root("", "halflit");
    root.allow_windows_style_options(false);  // "/models/duck.glb" is a path
    root.set_help_flag("-h,--help");
    root.set_help_all_flag("--help-all");
    root.set_version_flag("-V,--version", "");
    bool self_test = false;
    root.add_flag_callback("--self-test", [&self_test] {
        self_test = true;
        throw CLI::CallForVersion();  // ends the parsing in the same way: it asks for no command
    });
    root.require_subcommand(1);
    for (const Command& command : commands) add_command(root, command, arguments);
    const bool verbose = root_is_verbose(arguments);
    const auto chosen = [&]() -> const Command* {
        const auto parsed = root.get_subcommands();
        if (parsed.empty()) return nullptr;
        return &*std::find_if(commands.begin(), commands.end(),
                              [&](const Command& command) { return command.name == parsed.front()->get_name(); });
    };
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    try {
        root.parse(std::move(arguments));
    } catch (const CLI::CallForVersion&) {
        return ParsedLine{nullptr, self_test ? ParsedLine::Wanted::self_test
                                   : verbose ? ParsedLine::Wanted::library_versions
                                             : ParsedLine::Wanted::version};
    } catch (const CLI::CallForAllHelp&) {
        return ParsedLine{chosen(), ParsedLine::Wanted::help_all};
    } catch (const CLI::CallForHelp&) {
        return ParsedLine{chosen(), ParsedLine::Wanted::help};
    } catch (const CLI::ParseError& error) {
        return fail(ErrorCode::usage, usage_message(root, error, commands, chosen()));
    }
    return ParsedLine{chosen(), ParsedLine::Wanted::run};
}

}  // namespace halflit::cli
