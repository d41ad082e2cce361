// A server of the Model Context Protocol in a process of its own, driven over pipes; and small models for it.
#pragma once

#include <nlohmann/json.hpp>

#include <chrono>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/program.hpp"

namespace halflit::test {

class McpServer {
public:
    explicit McpServer(const std::string& root, const std::vector<std::string>& flags = {});

    void send(const std::string& line) const;
    /// The next line. Fails the test if none comes for two minutes.
    [[nodiscard]] nlohmann::json read();
    /// Sends a request and reads its answer.
    [[nodiscard]] nlohmann::json ask(const std::string& method, nlohmann::json params = nlohmann::json::object());
    /// With the newest version.
    void initialize();
    /// The result of a tool.
    [[nodiscard]] nlohmann::json call(const std::string& tool, const nlohmann::json& arguments);
    /// Closes its input; the exit code.
    int end();

private:
    PipedProgram program_;
    int next_id_ = 1;
    std::string unread_;
};

/// The id, as JSON, of the answer that a line must get; none: it gets no answer. For the newest version, which has no lists.
[[nodiscard]] std::optional<std::string> id_of_answer(const std::string& line);

[[nodiscard]] std::string decoded_base64(const std::string& text);

/// Closed boxes: ASCII STL from the origin to a corner; glTF with a unit box "outer" and inside it "inner", of half its sides.
[[nodiscard]] std::string box_stl(double x, double y, double z);
[[nodiscard]] std::string assembly_gltf();
/// A level grid of n x n squares with this side, as OBJ.
[[nodiscard]] std::string grid_obj(int n, double side);

}  // namespace halflit::test
