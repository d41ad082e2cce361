// Functions of halflit.h that call the engine by name: look, compare, explain and others.
#include "apps/c/boundary.hpp"
#include "apps/c/convert.hpp"
#include "apps/c/scene_handle.hpp"
#include "apps/c/versioned.hpp"
#include "apps/engine/calls/call_text.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/setting_flags.hpp"
#include "apps/engine/request/values.hpp"

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
    [[nodiscard]] Result<engine::SceneSource> load(const engine::ModelRequest& /*model*/) override {
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

Result<halflit_answer> answer_of(const char* name, const char* arguments, const halflit_scene* scene) {
    const auto call = engine::call_of_text(name, arguments, scene != nullptr ? engine::ModelOf::caller : engine::ModelOf::arguments);
    if (!call) return tl::unexpected<Error>(call.error());
    std::optional<SceneOfHandle> keeper;
    if (scene != nullptr) keeper.emplace(*scene);
    auto answer = engine::answer_call(*call, keeper ? &*keeper : nullptr);
    if (!answer) return tl::unexpected<Error>(answer.error());
    halflit_answer made{engine::to_text(answer->report, true), {}, std::move(answer->picture), answer->good};
    for (const std::string& note : answer->notes) made.notes.append(note).append("\n");
    return made;
}

}  // namespace

int32_t halflit_settings_read(halflit_settings* to, const char* name, const char* value) {
    return guarded(__func__, {{to, "settings"}, {name, "name"}, {value, "value"}}, [&]() -> Result<void> {
        auto read = settings(to);
        if (!read) return tl::unexpected<Error>(read.error());
        if (auto ok = engine::read_setting(*read, name, value); !ok) return ok;
        return write_struct(to_c(*read), to, "halflit_settings");
    });
}

int32_t halflit_read_color(const char* text, float color[4]) {
    return guarded(__func__, {{text, "text"}, {color, "color"}}, [&]() -> Result<void> {
        const auto read = engine::parse_color(text);
        if (!read) return tl::unexpected<Error>(read.error());
        color[0] = read->x, color[1] = read->y, color[2] = read->z, color[3] = read->w;
        return {};
    });
}

int32_t halflit_call(const char* name, const char* arguments, const halflit_scene* scene, halflit_answer** answer) {
    return guarded(__func__, {{name, "name"}, {answer, "answer"}}, [&]() -> Result<void> {
        auto made = answer_of(name, arguments, scene);
        if (!made) return tl::unexpected<Error>(made.error());
        *answer = std::make_unique<halflit_answer>(std::move(*made)).release();
        return {};
    });
}

int32_t halflit_call_check(const char* name, const char* arguments) {
    return guarded(__func__, {{name, "name"}}, [&]() -> Result<void> {
        const auto call = engine::call_of_text(name, arguments, engine::ModelOf::any);
        return call ? engine::check_call(*call) : tl::unexpected<Error>(call.error());
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
