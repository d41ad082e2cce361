// The command line as tables: commands, their arguments and their flags. The parser and every help text are made from them.
#pragma once

#include "halflit/error.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::engine {

/// Takes one value; its error becomes "--flag: expected ..., found ...".
using ReadValue = std::function<Result<void>(const std::string& text)>;

/// An argument that is known by its place.
struct Positional {
    std::string name;  ///< as help shows it: "SCENE"
    std::string help;
    ReadValue read;
    bool required = false;
    bool repeated = false;  ///< takes all arguments that are left
    std::string form{};     ///< as in Flag, for completion: FILE if files are meant
    std::string usage{};    ///< in the usage line; empty: from the name
};

/// The first stage that is done anew where a value changes: a model is loaded, lit and drawn.
enum class Stage : std::uint8_t { load, light, draw };

struct Flag {
    std::string names;  ///< "-o,--output"; the long name is last
    std::string form;   ///< the value: "off|on", "FILE"; words in capitals stand for something. Empty: a switch, which takes no value
    std::string help;
    ReadValue read;                ///< called for each use; for a switch with an empty text
    bool repeated = false;         ///< may be given several times
    std::optional<Stage> stage{};  ///< empty: that of the group

    /// "--output"
    [[nodiscard]] std::string long_name() const { return names.substr(names.rfind(',') + 1); }
};

struct FlagGroup {
    std::string title;
    std::vector<Flag> flags;
    Stage stage = Stage::load;
};

struct Command {
    enum class Listed { by_help, by_help_all, never };

    std::string name, help;
    std::vector<Positional> positionals;
    std::vector<FlagGroup> groups;
    std::function<Result<int>()> run;  ///< the exit code: 0, or 1 for a negative result
    Listed listed = Listed::by_help_all;
    std::vector<std::string> examples{};  ///< command lines, shown by every help text
    std::vector<std::string> usual{};     ///< long names of the flags that --help shows, in its order; empty: all
    bool lacking = false;                 ///< this build cannot run it: left out of what the program offers, but not of its reference

    [[nodiscard]] bool is_hidden() const { return listed == Listed::never; }
    [[nodiscard]] bool is_offered() const { return !is_hidden() && !lacking; }
};

/// Stores a parsed value in `target`, or returns its error; for use in a ReadValue.
template <class Target, class T>
Result<void> assign(Target& target, const Result<T>& value) {
    if (!value) return tl::unexpected(value.error());
    target = *value;
    return {};
}

/// Reads with a parser of values.hpp.
template <class Target, class Parser>
[[nodiscard]] ReadValue parsed(Target& target, Parser parser) {
    return [&target, parser](const std::string& text) { return assign(target, parser(text)); };
}

/// Stores the text itself.
[[nodiscard]] inline ReadValue read_text(std::string& target) {
    return [&target](const std::string& text) -> Result<void> {
        target = text;
        return {};
    };
}

/// Appends the text, for what may be given several times.
[[nodiscard]] inline ReadValue append_to(std::vector<std::string>& target) {
    return [&target](const std::string& text) -> Result<void> {
        target.push_back(text);
        return {};
    };
}

/// Appends what a parser reads.
template <class T, class Parser>
[[nodiscard]] ReadValue appended(std::vector<T>& target, Parser parser) {
    return [&target, parser](const std::string& text) { return parser(text).map([&](T value) { target.push_back(std::move(value)); }); };
}

/// Sets a switch.
[[nodiscard]] inline ReadValue set_to(bool& target, bool value = true) {
    return [&target, value](const std::string&) -> Result<void> {
        target = value;
        return {};
    };
}

/// Reads a whole number from `min` to `max`.
[[nodiscard]] ReadValue read_int(int& target, int min, int max);

/// The words of a form or of names that `separator` divides.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text, char separator);

/// The words with `separator` between them.
[[nodiscard]] std::string joined(const std::vector<std::string>& words, std::string_view separator);

/// All flags of a command, in the order of its groups.
[[nodiscard]] std::vector<const Flag*> flags_of(const Command& command);

/// By Stage: the flags that were read, each with its value, one a line. Equal lines make the stage equal.
using StageLines = std::array<std::string, 3>;

/// Reads flags as words: each by one of its names, its value as the next word or behind '='. Errors begin with the flag's name.
[[nodiscard]] Result<StageLines> read_flags(const std::vector<FlagGroup>& groups, std::span<const std::string> words);

/// True if a value of the flag may be a number: a word of its form stands for one.
[[nodiscard]] bool takes_number(const Flag& flag);

/// Removes the flags of these long names.
void remove_flags(std::vector<FlagGroup>& groups, std::span<const std::string_view> long_names);

/// Changes "(default usual)" in a flag's help, where a command has a default of its own.
void tell_default(std::vector<FlagGroup>& groups, std::string_view name, const std::string& usual, const std::string& own);

}  // namespace halflit::engine
