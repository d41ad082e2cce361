// Functions of halflit.h that call the engine by name: look, compare, explain and others.
#include "apps/c/boundary.hpp"
#include "apps/c/scene_handle.hpp"
#include "apps/c/versioned.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/calls/call.hpp"
#include "apps/engine/job/scene_source.hpp"

#include <memory>
#include <utility>

using namespace halflit;
using namespace halflit::c;

struct halflit_answer {
    std::string report, notes;
    std::optional<Image> picture;
    bool good = true;
};

namespace {

/// Gives each call a copy of a caller's scene, which the call may change.
class SceneOfHandle : public engine::SceneKeeper {
public:
    explicit SceneOfHandle(const halflit_scene& scene) : from_(scene) {}
    [[nodiscard]] Result<engine::SceneSource> load(const engine::RenderOptions& /*options*/) override {
        const std::lock_guard lock(from_.access);
        LoadedScene loaded;
        loaded.scene = from_.scene;
        loaded.nodes = from_.nodes;
        loaded.node_of_instance = from_.node_of_instance;
        auto parts = loaded.nodes.empty() ? std::make_shared<engine::Parts>(loaded.scene) : std::make_shared<engine::Parts>(loaded);
        return engine::SceneSource{.name = from_.name,
                                   .scene = std::make_unique<Scene>(std::move(loaded.scene)),
                                   .file = from_.info,
                                   .warnings = from_.warnings,
                                   .animations = from_.animations,
                                   .placement = from_.world.placement(),
                                   .motion = from_.motion,
                                   .parts = std::move(parts)};
    }

private:
    const halflit_scene& from_;
};

Result<halflit_answer> answer_of(const char* name, const char* given, const halflit_scene* scene) {
    const auto row = engine::find_call(name);
    if (!row) return tl::unexpected<Error>(row.error());
    auto arguments = nlohmann::json::parse(given != nullptr ? given : "{}", nullptr, false);
    if (!arguments.is_object()) return fail(ErrorCode::usage, "arguments: expected a JSON object");
    const engine::Call call = (*row)->make();
    std::optional<SceneOfHandle> keeper;
    if (scene != nullptr) {
        if (call.scenes.size() != 1 || arguments.contains("path") || arguments.contains("a"))
            return fail(ErrorCode::usage, std::string(name) + ": expected either a scene or the path of a model");
        arguments["path"] = "demo";  // a name that needs no file: the keeper has the scene
        keeper.emplace(*scene);
    }
    if (const auto read = engine::read_arguments(**row, call, arguments, [](const std::string& path) { return Result<std::string>(path); });
        !read)
        return tl::unexpected<Error>(read.error());
    for (engine::RenderOptions* const options : call.scenes) options->keeper = keeper ? &*keeper : nullptr;
    auto answer = engine::within_time(call.scenes.front()->timeout_s, call.run);
    if (!answer) return tl::unexpected<Error>(answer.error());
    halflit_answer made{engine::to_text(answer->report, true), {}, std::move(answer->picture), answer->good};
    for (const std::string& note : answer->notes) made.notes.append(note).append("\n");
    return made;
}

}  // namespace

int32_t halflit_call(const char* name, const char* arguments, const halflit_scene* scene, halflit_answer** answer) {
    return guarded(__func__, {{name, "name"}, {answer, "answer"}}, [&]() -> Result<void> {
        auto made = answer_of(name, arguments, scene);
        if (!made) return tl::unexpected<Error>(made.error());
        *answer = std::make_unique<halflit_answer>(std::move(*made)).release();
        return {};
    });
}

const char* halflit_answer_report(const halflit_answer* answer) { return answer == nullptr ? "" : answer->report.c_str(); }

const char* halflit_answer_notes(const halflit_answer* answer) { return answer == nullptr ? "" : answer->notes.c_str(); }

int32_t halflit_answer_is_good(const halflit_answer* answer) { return answer != nullptr && answer->good ? 1 : 0; }

const void* halflit_answer_picture(const halflit_answer* answer, int32_t* width, int32_t* height) {
    const bool has = answer != nullptr && answer->picture;
    if (width != nullptr) *width = has ? answer->picture->width : 0;
    if (height != nullptr) *height = has ? answer->picture->height : 0;
    return has ? answer->picture->rgba8.data() : nullptr;
}

void halflit_answer_destroy(halflit_answer* answer) { delete answer; }
