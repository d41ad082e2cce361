// The part of the module for the npm package: reports, descriptions, the engine's calls, and the program's flags.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/answers/scene_description.hpp"
#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/calls/call_text.hpp"
#include "apps/web/flag_table.hpp"
#include "apps/web/module.hpp"

#include <emscripten/emscripten.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <utility>

using namespace halflit;
using web::Handle;

namespace {

std::optional<Image> of_call;  ///< the picture of the last call

}  // namespace

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

/// As text: {"good", "notes", "hash" (of the picture), "report"} of one of the engine's calls, whose picture the next three functions have.
/// arguments: JSON, without the path of the scene's model.
EMSCRIPTEN_KEEPALIVE int halflit_call(Handle* handle, const char* name, const char* arguments) {
    of_call.reset();
    return web::attempt_on(*handle, [&]() -> Result<void> {
        const auto row = engine::find_call(name);
        const bool takes_path = row && engine::takes_path(**row);
        const auto model = takes_path ? engine::ModelOf::caller : engine::ModelOf::arguments;
        const auto call = engine::call_of_text(name, arguments, model, handle->scene);
        if (!call) return tl::unexpected(call.error());
        for (engine::RenderOptions* const options : call->scenes) options->execution.threads = 1;
        auto answer = engine::answer_call(*call, nullptr);
        if (!answer) return tl::unexpected(answer.error());
        const std::string hash = answer->picture ? engine::hash_text(answer->picture->rgba8) : "";
        handle->text = engine::to_text(
            {{"good", answer->good}, {"notes", answer->notes}, {"hash", hash}, {"report", std::move(answer->report)}}, true);
        of_call = std::move(answer->picture);
        return {};
    });
}
/// Null: it has none.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_call_pixels() { return of_call ? of_call->rgba8.data() : nullptr; }
EMSCRIPTEN_KEEPALIVE int halflit_call_width() { return of_call ? of_call->width : 0; }
EMSCRIPTEN_KEEPALIVE int halflit_call_height() { return of_call ? of_call->height : 0; }

/// JSON of the flags that the module takes.
EMSCRIPTEN_KEEPALIVE const char* halflit_flags() {
    static std::string table;
    table = web::flag_table();
    return table.c_str();
}

}  // extern "C"
