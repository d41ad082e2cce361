// `halflit mcp`: the server of the Model Context Protocol on standard input and output.
#pragma once

#include "apps/halflit/flags/agent_pages.hpp"
#include "halflit/error.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace halflit::cli {

struct McpOptions {
    std::string root = ".";  ///< models are read below it
    bool allow_external = false;
    double timeout_s = 60.0;           ///< of a call
    std::size_t max_memory_bytes = 0;  ///< of the process; 0: no limit
};

/// The tools that it offers, for the documentation.
[[nodiscard]] std::vector<NamedHelp> tool_helps();

/// Answers messages until standard input ends: 0. Fails (io) if the root is no folder, or standard output cannot be written.
[[nodiscard]] Result<int> serve(const McpOptions& options);

}  // namespace halflit::cli
