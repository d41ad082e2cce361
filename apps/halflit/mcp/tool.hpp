// The engine's calls as tools of the Model Context Protocol: a picture is encoded, and may be written below the server's folder.
#pragma once

#include "apps/engine/calls/call.hpp"
#include "apps/halflit/program/engine.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::cli {

struct ToolPicture {
    std::vector<std::uint8_t> bytes;  ///< of the file; empty: none
    std::string mime_type;
};

struct ToolAnswer {
    std::vector<std::string> notes;  ///< lines before the report: faults first
    Json report;                     ///< an object
    ToolPicture picture{};
};

/// The calls that are tools; CallRow::tool is the tool's name.
[[nodiscard]] std::vector<const CallRow*> all_tools();

/// A call of the tool with defaults. Where it draws a picture, it has the flag --output, whose path goes to `output`.
[[nodiscard]] Call make_call(const CallRow& tool, std::string& output);

/// {"name", "description", "inputSchema", "annotations"}
[[nodiscard]] Json tool_json(const CallRow& tool);

/// PNG for no name. Fails (usage) for a format that agents do not see.
[[nodiscard]] Result<OutputFormat> format_of_output(const std::string& output);

/// Encodes the picture of an answer, and writes it to `output`; empty: nowhere. Fails (io) where that is a file that was read.
[[nodiscard]] Result<ToolAnswer> tool_answer(Answer answer, const std::string& output, OutputFormat format);

}  // namespace halflit::cli
