// The tools that agents call, as a table. From a row follow its entry in tools/list, the check of its arguments, and the call.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/mcp/model_folder.hpp"
#include "apps/halflit/program/engine.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::cli {

/// Forms of flags whose value is a path: of a model or the name of a built-in scene, of another file, of a picture that is written.
/// ModelFolder resolves them.
inline constexpr const char* kModelForm = "MODEL";
inline constexpr const char* kFileForm = "FILE";
inline constexpr const char* kPictureForm = "PICTURE";

/// A picture that a tool gives.
struct ToolPicture {
    std::vector<std::uint8_t> bytes;  ///< of the file; empty: none
    std::string mime_type;
};

struct ToolAnswer {
    std::vector<std::string> notes;  ///< lines before the report: faults first
    Json report;                     ///< an object
    ToolPicture picture{};
};

/// One call: flags that are read from its arguments, and the function that runs it. The flags and `run` own what they refer to.
struct ToolCall {
    std::vector<FlagGroup> groups;
    std::vector<RenderOptions*> scenes;  ///< options of each scene that is drawn; limits are set there
    std::function<Result<ToolAnswer>()> run;
};

struct Tool {
    std::string name, help;
    bool writes = false;                  ///< it has --output
    std::vector<std::string_view> shown;  ///< long names of flags in the schema; others of the call are taken too
    std::vector<std::string_view> required;
    std::function<ToolCall()> make;  ///< a call with defaults
};

[[nodiscard]] std::span<const Tool> all_tools();

/// {"name", "description", "inputSchema", "annotations"}
[[nodiscard]] Json tool_json(const Tool& tool);

/// Reads arguments by the call's flags: "hidden-edges" is --hidden-edges. Numbers and true for a switch are taken as their texts, and a
/// list for a flag that may be repeated. Fails (usage) with the argument's name.
[[nodiscard]] Result<void> read_arguments(const Tool& tool, const ToolCall& call, const nlohmann::json& arguments,
                                          const ModelFolder& folder);

}  // namespace halflit::cli
