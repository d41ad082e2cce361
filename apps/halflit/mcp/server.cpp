#include "apps/halflit/mcp/server.hpp"

#include "apps/engine/basics/base64.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/calls/answer_limits.hpp"
#include "apps/engine/calls/kept_scenes.hpp"
#include "apps/halflit/farm/picture_file.hpp"
#include "apps/halflit/mcp/message_queue.hpp"
#include "apps/halflit/mcp/session.hpp"
#include "apps/halflit/mcp/tool.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/process.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace halflit::cli {
namespace {

constexpr std::size_t kMostSentBytes = std::size_t{16} << 20;  // that are sent
constexpr const char* kInstructions =
    "halflit looks at 3D models (glTF, STL, PLY, OBJ, OFF, 3MF). After making or changing a model, call look: it shows labelled views and "
    "reports what they show. Lines that begin with FAULT tell what must not be relied on. Then measure, section or explain what is in "
    "doubt. "
    "Paths are relative to the server's folder.";

Json text_content(std::string text) { return {{"type", "text"}, {"text", std::move(text)}}; }

Json error_result(const std::string& message) { return {{"content", Json::array({text_content("error: " + message)})}, {"isError", true}}; }

Json result_of(ToolAnswer answer) {
    if (answer.picture.bytes.size() > kMostSentBytes) {
        answer.picture.bytes.clear();
        answer.notes.emplace_back("The picture is too large to be sent; a smaller size or an output shows it");
    }
    answer.report = bounded_report(std::move(answer.report));
    if (answer.report.contains("left_out"))
        answer.notes.emplace_back("Long lists are cut: left_out counts what is not here; the command line's reports are whole");
    std::string text;
    for (const std::string& note : answer.notes) text += note + "\n";
    Json content = Json::array({text_content(bounded_lines(std::move(text)) + to_text(answer.report, true))});
    if (!answer.picture.bytes.empty())
        content.push_back({{"type", "image"}, {"data", base64(answer.picture.bytes)}, {"mimeType", answer.picture.mime_type}});
    return {{"content", std::move(content)}, {"isError", false}};
}

class Tools : public ToolHost {
public:
    Tools(const McpOptions& options, ModelFolder folder, MessageQueue& queue)
        : options_(options), folder_(std::move(folder)), queue_(queue) {}

    [[nodiscard]] Json list() const override {
        Json list = Json::array();
        for (const CallRow* const tool : all_tools()) list.push_back(tool_json(*tool));
        return list;
    }
    [[nodiscard]] std::optional<std::string> unknown(const std::string& name) const override {
        std::vector<std::string> names;
        for (const CallRow* const tool : all_tools()) names.push_back(tool->tool);
        return std::find(names.begin(), names.end(), name) != names.end() ? std::nullopt : std::optional(did_you_mean(name, names));
    }
    [[nodiscard]] std::optional<Json> call(const nlohmann::json& id, const std::string& name, const nlohmann::json& arguments) override {
        const auto tools = all_tools();
        const CallRow& tool = **std::find_if(tools.begin(), tools.end(), [&](const CallRow* one) { return one->tool == name; });
        queue_.begin_call(id);
        Json result;
        try {
            auto answer = run(tool, arguments);
            result = answer ? result_of(std::move(*answer)) : error_result(answer.error().message);
        } catch (const std::bad_alloc&) {
            result = error_result("out of memory");
        } catch (const std::exception& exception) {
            result = error_result(std::string("internal error: ") + exception.what());
        }
        queue_.end_call();
        if (queue_.cancelled()) return std::nullopt;
        return result;
    }
    [[nodiscard]] std::string instructions() const override { return kInstructions; }

private:
    Result<ToolAnswer> run(const CallRow& tool, const nlohmann::json& arguments) {
        std::string output;
        const Call call = make_call(tool, output);
        const auto resolve = [this](const std::string& path, PathUse use) {
            return use == PathUse::read ? folder_.to_read(path) : folder_.to_write(path);
        };
        if (const auto read = read_arguments(tool, call, arguments, resolve); !read) return tl::unexpected(read.error());
        const auto format = format_of_output(output);
        if (!format) return tl::unexpected(format.error());
        for (RenderOptions* const scene : call.scenes) {
            scene->keeper = &kept_;
            scene->timeout_s = scene->timeout_s > 0.0 ? std::min(scene->timeout_s, options_.timeout_s) : options_.timeout_s;
            scene->max_memory_bytes = options_.max_memory_bytes;
            scene->execution.cancelled = [this] { return queue_.cancelled(); };
        }
        io::begin_file_set();
        const auto answered = [&]() -> Result<ToolAnswer> {
            auto answer = call.run();
            if (!answer) return tl::unexpected(answer.error());
            return tool_answer(std::move(*answer), output, *format);
        };
        return within_memory(*call.scenes.front(), [&] { return within_time(options_.timeout_s, answered); });
    }

    const McpOptions& options_;
    ModelFolder folder_;
    MessageQueue& queue_;
    KeptScenes kept_;
};

}  // namespace

std::vector<NamedHelp> tool_helps() {
    std::vector<NamedHelp> helps;
    for (const CallRow* const tool : all_tools()) helps.push_back({tool->tool, tool->help});
    return helps;
}

Result<int> serve(const McpOptions& options) {
    auto folder = ModelFolder::enter(options.root, options.allow_external);
    if (!folder) return tl::unexpected(folder.error());
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    const auto queue = MessageQueue::start(platform::standard_input());
    Tools tools(options, std::move(*folder), *queue);
    McpSession session(tools);
    while (const auto message = queue->next()) {
        const Json answer = message->error != 0 ? rpc_error({}, message->error, message->reason) : session.answer(message->message);
        if (answer.is_null()) continue;
        if (const auto written = write_text("-", to_text(answer, true)); !written) return tl::unexpected(written.error());
    }
    return 0;
}

}  // namespace halflit::cli
