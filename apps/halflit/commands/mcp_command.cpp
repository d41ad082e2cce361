// halflit mcp: tools for agents, over the Model Context Protocol.
#include "apps/engine/request/file_flags.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/mcp/server.hpp"

#include <fmt/core.h>

#include <memory>

namespace halflit::cli {

Command mcp_command() {
    const auto options = std::make_shared<McpOptions>();
    McpOptions& o = *options;
    return {
        "mcp",
        "Offer tools to agents: the Model Context Protocol on standard input and output",
        {},
        {{"Server",
          {{"--root", "FOLDER", "Read models below this folder, and write pictures there (default: the current one)", read_text(o.root)},
           {"--allow-external", "", "Read files outside of that folder too", set_to(o.allow_external)},
           timeout_flag(o.timeout_s,
                        fmt::format("Time limit of a call; one that takes longer ends with an error (default {})", o.timeout_s)),
           {"--max-memory", "MIB",
            "Memory limit of the process, at least 32; a call that needs more ends with an error (default: no limit)",
            parsed(o.max_memory_bytes, parse_memory)}}}},
        [options] { return serve(*options); }};
}

}  // namespace halflit::cli
