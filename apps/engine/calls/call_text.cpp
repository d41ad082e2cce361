#include "apps/engine/calls/call_text.hpp"

#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/flags.hpp"

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

/// Usage errors name flags, as the program has them. Here they are names of arguments. Hyphens within a word stay.
Error with_names(const Error& error) {
    if (error.code != ErrorCode::usage) return error;
    const std::string& from = error.message;
    std::string message;
    for (std::size_t at = 0; at < from.size(); ++at) {
        const bool begins = message.empty() || message.back() == ' ';
        if (begins && from.compare(at, 2, "--") == 0 && at + 2 < from.size() && from[at + 2] != ' ') at += 2;
        message += from[at];
    }
    return {error.code, std::move(message)};
}

/// A note of several lines as several notes.
Answer with_single_lines(Answer answer) {
    std::vector<std::string> lines;
    for (const std::string& note : answer.notes)
        for (std::string& line : words_of(note, '\n')) lines.push_back(std::move(line));
    answer.notes = std::move(lines);
    return answer;
}

}  // namespace

bool takes_path(const CallRow& row) { return std::find(row.required.begin(), row.required.end(), "path") != row.required.end(); }

Result<Call> call_of_text(const char* name, const char* arguments, ModelOf model, const std::string& path) {
    const auto row = find_call(name);
    if (!row) return tl::unexpected(row.error());
    auto given = nlohmann::json::parse(arguments != nullptr ? arguments : "{}", nullptr, false);
    if (!given.is_object()) return fail(ErrorCode::usage, "arguments: expected a JSON object");
    Call call = (*row)->make();
    if (model == ModelOf::caller) {
        if (!takes_path(**row) || given.contains("path"))
            return fail(ErrorCode::usage, std::string(name) + ": expected either a scene or the path of a model");
        given["path"] = path;
    } else if (model == ModelOf::any && takes_path(**row) && !given.contains("path")) {
        given["path"] = path;
    }
    const auto as_given = [](const std::string& of_file, PathUse /*use*/) { return Result<std::string>(of_file); };
    if (const auto read = read_arguments(**row, call, given, as_given); !read) return tl::unexpected(read.error());
    return call;
}

Result<void> check_call(const Call& call) { return call.check ? call.check().map_error(with_names) : Result<void>(); }

Result<Answer> answer_call(const Call& call, SceneKeeper* keeper) {
    for (RenderOptions* const options : call.scenes) options->keeper = keeper;
    return within_time(call.scenes.front()->timeout_s, call.run).map(with_single_lines).map_error(with_names);
}

}  // namespace halflit::engine
