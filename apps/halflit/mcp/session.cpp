#include "apps/halflit/mcp/session.hpp"

#include "halflit/version.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

namespace halflit::cli {
namespace {

using Message = nlohmann::json;

constexpr std::string_view kProtocols[] = {"2024-11-05", "2025-03-26", "2025-06-18"};
constexpr std::string_view kProtocolWithBatches = "2025-03-26";  // the others have none
constexpr std::size_t kMostBatch = 32;                           // messages

enum RpcCode : int { kInvalidRequest = -32600, kUnknownMethod = -32601, kInvalidParams = -32602, kInternalError = -32603 };

Json rpc_result(const Message& id, Json result) { return {{"jsonrpc", "2.0"}, {"id", Json(id)}, {"result", std::move(result)}}; }

bool is_id(const Message& id) { return id.is_string() || id.is_number(); }

/// The text of a key; empty if there is none.
std::string text_of(const Message& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

Json rpc_error(const Message& id, int code, const std::string& message) {
    return {{"jsonrpc", "2.0"}, {"id", is_id(id) ? Json(id) : Json()}, {"error", {{"code", code}, {"message", message}}}};
}

Json McpSession::answer(const Message& message) {
    if (!message.is_array()) return answer_one(message);
    if (version_ != kProtocolWithBatches)
        return rpc_error({}, kInvalidRequest, "expected one message, found a list: only version 2025-03-26 of the protocol has lists");
    if (message.empty() || message.size() > kMostBatch)
        return rpc_error({}, kInvalidRequest, "expected a list of 1 to " + std::to_string(kMostBatch) + " messages");
    Json answers = Json::array();
    for (const Message& one : message)
        if (Json answered = answer_one(one); !answered.is_null()) answers.push_back(std::move(answered));
    return answers.empty() ? Json() : answers;
}

Json McpSession::answer_one(const Message& message) {
    if (!message.is_object()) return rpc_error({}, kInvalidRequest, "expected an object");
    const auto found = message.find("id");
    const bool has_id = found != message.end();
    const Message id = has_id ? *found : Message();
    if (!message.contains("method") && (message.contains("result") || message.contains("error"))) return {};  // an answer to nothing
    if (has_id && !is_id(id)) return rpc_error({}, kInvalidRequest, "id: expected a string or a number");
    if (text_of(message, "jsonrpc") != "2.0") return rpc_error(id, kInvalidRequest, "jsonrpc: expected \"2.0\"");
    const std::string method = text_of(message, "method");
    if (method.empty()) return rpc_error(id, kInvalidRequest, "method: expected a name");
    if (!has_id) return {};  // a notification
    const auto given = message.find("params");
    const Message params = given != message.end() && !given->is_null() ? *given : Message::object();
    if (!params.is_object()) return rpc_error(id, kInvalidParams, "params: expected an object");
    try {
        return answer_method(method, id, params);
    } catch (const std::bad_alloc&) {
        return rpc_error(id, kInternalError, "out of memory");
    } catch (const std::exception& exception) {
        return rpc_error(id, kInternalError, std::string("internal error: ") + exception.what());
    }
}

Json McpSession::answer_method(const std::string& method, const Message& id, const Message& params) {
    if (method == "initialize") return rpc_result(id, initialize(params));
    if (method == "ping") return rpc_result(id, Json::object());
    if (method == "tools/list") return rpc_result(id, {{"tools", host_.list()}});
    if (method == "tools/call") return call(id, params);
    return rpc_error(id, kUnknownMethod, "unknown method '" + method + "'");
}

Json McpSession::initialize(const Message& params) {
    const std::string asked = text_of(params, "protocolVersion");
    const bool known = std::find(std::begin(kProtocols), std::end(kProtocols), asked) != std::end(kProtocols);
    version_ = known ? asked : std::string(*std::prev(std::end(kProtocols)));
    return {{"protocolVersion", version_},
            {"capabilities", {{"tools", {{"listChanged", false}}}}},
            {"serverInfo", {{"name", "halflit"}, {"version", std::string(version())}}},
            {"instructions", host_.instructions()}};
}

Json McpSession::call(const Message& id, const Message& params) {
    const auto name = params.find("name");
    if (name == params.end() || !name->is_string()) return rpc_error(id, kInvalidParams, "name: expected the name of a tool");
    const auto given = params.find("arguments");
    const Message arguments = given != params.end() && !given->is_null() ? *given : Message::object();
    if (!arguments.is_object()) return rpc_error(id, kInvalidParams, "arguments: expected an object");
    const std::string tool = name->get<std::string>();
    if (const auto hint = host_.unknown(tool)) return rpc_error(id, kInvalidParams, "unknown tool '" + tool + "'" + *hint);
    auto result = host_.call(id, tool, arguments);
    return result ? rpc_result(id, std::move(*result)) : Json();
}

}  // namespace halflit::cli
