// The Model Context Protocol over JSON-RPC 2.0: what is answered to each message. It knows of tools only what ToolHost says.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/halflit/program/engine.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace halflit::cli {

/// The tools that a session offers.
class ToolHost {
public:
    virtual ~ToolHost() = default;
    /// [{"name", "description", "inputSchema", ..}]
    [[nodiscard]] virtual Json list() const = 0;
    /// " (did you mean NAME?)" or nothing, for a name that no tool has; none for one that a tool has.
    [[nodiscard]] virtual std::optional<std::string> unknown(const std::string& name) const = 0;
    /// The result, {"content", "isError", ..}; none if the call was cancelled. arguments: an object.
    [[nodiscard]] virtual std::optional<Json> call(const nlohmann::json& id, const std::string& name, const nlohmann::json& arguments) = 0;
    /// For the model that uses the tools.
    [[nodiscard]] virtual std::string instructions() const = 0;
};

class McpSession {
public:
    explicit McpSession(ToolHost& host) : host_(host) {}

    /// The answer: an object, or a list of them for a batch; null where none is due.
    [[nodiscard]] Json answer(const nlohmann::json& message);

private:
    [[nodiscard]] Json answer_one(const nlohmann::json& message);
    [[nodiscard]] Json answer_method(const std::string& method, const nlohmann::json& id, const nlohmann::json& params);
    [[nodiscard]] Json initialize(const nlohmann::json& params);
    [[nodiscard]] Json call(const nlohmann::json& id, const nlohmann::json& params);

    ToolHost& host_;
    std::string version_;  ///< of the protocol; empty: not yet agreed
};

/// {"jsonrpc", "id", "error": {"code", "message"}}
[[nodiscard]] Json rpc_error(const nlohmann::json& id, int code, const std::string& message);

}  // namespace halflit::cli
