// The part of the npm package's module beside module.cpp: the program's report and description of a scene, and its flags.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/answers/scene_description.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/calls/call.hpp"
#include "apps/npm/flag_table.hpp"
#include "apps/npm/module.hpp"

#include <emscripten/emscripten.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

using namespace halflit;
using web::Handle;

namespace {
std::optional<Image> of_call;  ///< the picture of the last call
}

extern "C" {

/// As text: the report of the last picture, as that of `halflit render --report`.
EMSCRIPTEN_KEEPALIVE int halflit_report(Handle* handle) {
    return web::attempt(handle->text, [&]() -> Result<void> {
        const engine::RenderJob* const job = handle->session.job();
        if (job == nullptr) return fail(ErrorCode::usage, "there is no picture yet");
        engine::Json report = engine::report_head("report");
        report["scene"] = job->source.name;
        engine::add_frame(report, *job, handle->session.rendered(), handle->session.picture());
        handle->text = engine::to_text(report, true);
        return {};
    });
}
/// As text: the scene, as `halflit info` describes it. json, parts: 1 for one JSON object, and for measures of each part.
EMSCRIPTEN_KEEPALIVE int halflit_info(Handle* handle, const char* flags, int json, int parts) {
    return web::attempt_on(*handle, [&]() -> Result<void> {
        if (auto applied = handle->session.apply(handle->scene, web::lines_of(flags)); !applied) return applied;
        return engine::describe_scene(*handle->session.job(), json != 0, parts != 0).map([&](std::string text) {
            handle->text = std::move(text);
        });
    });
}

/// As text: {"good", "notes", "report"} of one of the engine's calls, whose picture halflit_call_pixels() has. arguments: JSON.
EMSCRIPTEN_KEEPALIVE int halflit_call(Handle* handle, const char* name, const char* arguments) {
    return web::attempt_on(*handle, [&]() -> Result<void> {
        of_call.reset();
        const auto row = engine::find_call(name);
        if (!row) return tl::unexpected(row.error());
        auto given = nlohmann::json::parse(arguments, nullptr, false);
        if (!given.is_object()) return fail(ErrorCode::usage, "arguments: expected an object");
        if (!given.contains("a")) given["path"] = handle->scene;
        const engine::Call call = (*row)->make();
        const auto as_given = [](const std::string& path) { return Result<std::string>(path); };
        if (const auto read = engine::read_arguments(**row, call, given, as_given); !read) return read;
        for (engine::RenderOptions* const options : call.scenes) options->execution.threads = 1;
        auto answer = engine::within_time(call.scenes.front()->timeout_s, call.run);
        if (!answer) return tl::unexpected(answer.error());
        handle->text = engine::to_text({{"good", answer->good}, {"notes", answer->notes}, {"report", std::move(answer->report)}}, true);
        of_call = std::move(answer->picture);
        return {};
    });
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_call_pixels() { return of_call ? of_call->rgba8.data() : nullptr; }
EMSCRIPTEN_KEEPALIVE int halflit_call_width() { return of_call ? of_call->width : 0; }
EMSCRIPTEN_KEEPALIVE int halflit_call_height() { return of_call ? of_call->height : 0; }

/// JSON of the flags that the module takes.
EMSCRIPTEN_KEEPALIVE const char* halflit_flags() {
    static std::string table;
    table = npm::flag_table();
    return table.c_str();
}

}  // extern "C"
