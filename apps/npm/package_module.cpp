// What the npm package's module has beside module.cpp: the program's report and description of a scene, and its flags.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/answers/scene_description.hpp"
#include "apps/npm/flag_table.hpp"
#include "apps/npm/module.hpp"

#include <emscripten/emscripten.h>
#include <nlohmann/json.hpp>

using namespace halflit;
using web::Handle;

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

/// JSON of the flags that the module takes.
EMSCRIPTEN_KEEPALIVE const char* halflit_flags() {
    static std::string table;
    table = npm::flag_table();
    return table.c_str();
}

}  // extern "C"
