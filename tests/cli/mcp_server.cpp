#include "tests/cli/mcp_server.hpp"

#include "tests/cli/small_models.hpp"
#include "tests/support/base64.hpp"
#include "tests/support/catch.hpp"

#include <array>

namespace halflit::test {
namespace {

using nlohmann::json;

/// Corners of the twelve triangles, counter-clockwise seen from outside; bit 0 is x, bit 1 y, bit 2 z.
constexpr std::array<std::array<unsigned, 3>, 12> kBox{
    {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}}};

std::vector<std::string> words_of(const std::string& root, const std::vector<std::string>& flags) {
    std::vector<std::string> words{HALFLIT_PROGRAM, "mcp", "--root", root};
    words.insert(words.end(), flags.begin(), flags.end());
    return words;
}

}  // namespace

McpServer::McpServer(const std::string& root, const std::vector<std::string>& flags) : program_(words_of(root, flags)) {}

void McpServer::send(const std::string& line) const { program_.write(line + "\n"); }

json McpServer::read() {
    std::size_t end = 0;
    while ((end = unread_.find('\n')) == std::string::npos) unread_ += program_.read();
    const json message = json::parse(unread_.substr(0, end));
    unread_.erase(0, end + 1);
    return message;
}

json McpServer::ask(const std::string& method, json params) {
    const int id = next_id_++;
    send(json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", std::move(params)}}.dump());
    json answer = read();
    CHECK(answer["id"] == id);
    return answer;
}

void McpServer::initialize() {
    CHECK(ask("initialize", {{"protocolVersion", "2025-06-18"}, {"capabilities", json::object()}}).contains("result"));
}

json McpServer::call(const std::string& tool, const json& arguments) {
    json answer = ask("tools/call", {{"name", tool}, {"arguments", arguments}});
    INFO(answer.dump().substr(0, 1000));
    REQUIRE(answer.contains("result"));
    return answer["result"];
}

int McpServer::end() { return program_.end(); }

std::optional<std::string> id_of_answer(const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return std::nullopt;
    const json message = json::parse(line, nullptr, false);
    if (!message.is_object()) return "null";
    const bool has_id = message.contains("id");
    const bool good_id = has_id && (message["id"].is_string() || message["id"].is_number());
    const std::string id = good_id ? message["id"].dump() : "null";
    if (!message.contains("method") && (message.contains("result") || message.contains("error"))) return std::nullopt;
    if (has_id && !good_id) return id;
    const bool call =
        message.value("jsonrpc", json()) == "2.0" && message.contains("method") && message["method"].is_string() && message["method"] != "";
    if (call && !has_id) return std::nullopt;
    return id;
}

std::string decoded_base64(const std::string& text) {
    const auto bytes = decode_base64(text);
    REQUIRE(bytes);
    return {bytes->begin(), bytes->end()};
}

std::string box_stl(double x, double y, double z) { return stl_of(box({0, 0, 0}, {x, y, z})); }

std::string assembly_gltf() {
    std::vector<std::uint8_t> bytes;
    const auto add = [&](std::uint32_t word) {
        for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
    };
    constexpr std::uint32_t kHalf = 0x3f000000;  // 0.5f; its sign bit is the highest
    for (unsigned corner = 0; corner < 8; ++corner)
        for (unsigned axis = 0; axis < 3; ++axis) add((corner >> axis & 1) != 0 ? kHalf : kHalf | 0x80000000u);
    for (const auto& triangle : kBox)
        for (const unsigned corner : triangle) add(corner);
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "outer", "mesh": 0}, {"name": "inner", "mesh": 0, "scale": [0.5, 0.5, 0.5]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                       "min": [-0.5, -0.5, -0.5], "max": [0.5, 0.5, 0.5]},
                      {"bufferView": 1, "componentType": 5125, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 144}],
        "buffers": [{"byteLength": 240, "uri": "data:application/octet-stream;base64,)" +
           encode_base64(bytes) + "\"}]}";
}

std::string grid_obj(int n, double side) {
    std::ostringstream text;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) text << "v " << i * side << " 0 " << j * side << '\n';
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j + 1, b = a + n + 1;
            text << "f " << a << ' ' << a + 1 << ' ' << b + 1 << ' ' << b << '\n';
        }
    return text.str();
}

}  // namespace halflit::test
