// The calls that front ends offer by name: look, render, measure, section, compare, explain, info and certify. From a row follow the check
// of a call's arguments, the call, and the tools of `halflit mcp`.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/render_options.hpp"
#include "halflit/image.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// Forms of flags whose value is a path: of a model or the name of a built-in scene, of another file, of a picture that is written.
inline constexpr const char* kModelForm = "MODEL";
inline constexpr const char* kFileForm = "FILE";
inline constexpr const char* kPictureForm = "PICTURE";

struct Answer {
    std::vector<std::string> notes;     ///< lines for people: faults first
    Json report;                        ///< an object
    std::optional<Image> picture{};     ///< 8-bit codes
    std::vector<std::string> inputs{};  ///< names of the models, and files that they refer to
    bool good = true;                   ///< false: a negative result, for which the program's exit code is 1
};

/// One call: flags that are read from its arguments, and the function that runs it. The flags and `run` own what they refer to.
struct Call {
    std::vector<FlagGroup> groups;
    std::vector<RenderOptions*> scenes;  ///< options of each scene that is drawn; limits are set there
    std::function<Result<Answer>()> run;
    std::function<Result<void>()> check{};  ///< what `run` would refuse before it loads a scene; empty: nothing
};

struct CallRow {
    std::string name, help;
    std::vector<std::string_view> shown;  ///< long names of flags that agents are told of; others of the call are taken too
    std::vector<std::string_view> required;
    bool has_picture = false;
    std::string tool;            ///< its name among the tools of `halflit mcp`; empty: none
    std::function<Call()> make;  ///< a call with defaults
};

[[nodiscard]] std::span<const CallRow> all_calls();
/// Fails (usage) for an unknown name, with one that may have been meant.
[[nodiscard]] Result<const CallRow*> find_call(std::string_view name);

enum class PathUse : std::uint8_t { read, write };
/// The path that is used for one that was given.
using ResolvePath = std::function<Result<std::string>(const std::string& path, PathUse use)>;

/// Reads arguments by the call's flags: "hidden-edges" and "hidden_edges" are --hidden-edges. Numbers and true for a switch are taken as
/// their texts, a list of numbers as a text with commas, and a list for a flag that may be repeated. Fails (usage) with the argument's
/// name.
[[nodiscard]] Result<void> read_arguments(const CallRow& row, const Call& call, const nlohmann::json& arguments,
                                          const ResolvePath& resolve);

/// The JSON schema of the arguments in CallRow::shown, as far as the call has their flags.
[[nodiscard]] Json arguments_schema(const CallRow& row, const Call& call);

}  // namespace halflit::engine
