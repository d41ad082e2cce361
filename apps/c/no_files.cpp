// Functions of the component io, in a build without it: what needs files is refused.
#include "apps/c/boundary.hpp"
#include "halflit/halflit.h"

#include <halflit/image.hpp>
#include <halflit/model.hpp>

namespace halflit {
namespace {

tl::unexpected<Error> refuse(const std::string& name) {
    return fail(ErrorCode::usage, name + ": this build of the library reads and writes no files (HALFLIT_BUILD_IO)");
}

}  // namespace

Result<LoadedScene> load_model(const std::string& path, const LoadOptions& /*options*/) { return refuse(path); }

Result<LoadedScene> load_model_bytes(std::span<const std::byte> /*bytes*/, const std::string& name, const std::string& /*base_dir*/,
                                     const LoadOptions& /*options*/) {
    return refuse(name);
}

Result<SceneChanges> pose_at(const Motion& /*motion*/, const std::string& /*animation*/, double /*time_s*/, Scene& /*scene*/,
                             std::span<Node> /*nodes*/) {
    return refuse("pose");
}

Result<EnvironmentImage> read_environment(const std::string& path, const EnvironmentLimits& /*limits*/) { return refuse(path); }

Result<OutputFormat> output_format_of(std::string_view path) { return refuse(std::string(path)); }

Result<std::vector<std::uint8_t>> encode_image(const Image& /*image*/, OutputFormat /*format*/) { return refuse("picture"); }

Result<void> write_image(const std::string& path, const Image& /*image*/) { return refuse(path); }

}  // namespace halflit

int32_t halflit_call(const char* name, const char* /*arguments*/, const halflit_scene* /*scene*/, halflit_answer** answer) {
    return halflit::c::guarded(__func__, {{name, "name"}, {answer, "answer"}},
                               [&]() -> halflit::Result<void> { return halflit::refuse(name); });
}
int32_t halflit_settings_read(halflit_settings* settings, const char* name, const char* /*value*/) {
    return halflit::c::guarded(__func__, {{settings, "settings"}, {name, "name"}},
                               [&]() -> halflit::Result<void> { return halflit::refuse(name); });
}
int32_t halflit_read_color(const char* text, float color[4]) {
    return halflit::c::guarded(__func__, {{text, "text"}, {color, "color"}},
                               [&]() -> halflit::Result<void> { return halflit::refuse(text); });
}
int32_t halflit_call_check(const char* name, const char* /*arguments*/) {
    return halflit::c::guarded(__func__, {{name, "name"}}, [&]() -> halflit::Result<void> { return halflit::refuse(name); });
}
const char* halflit_answer_report(const halflit_answer* /*answer*/) { return ""; }
const char* halflit_answer_notes(const halflit_answer* /*answer*/) { return ""; }
int32_t halflit_answer_is_good(const halflit_answer* /*answer*/) { return 0; }
const void* halflit_answer_picture(const halflit_answer* /*answer*/, int32_t* /*width*/, int32_t* /*height*/) { return nullptr; }
void halflit_answer_destroy(halflit_answer* /*answer*/) {}

namespace {
int32_t refuse_mujoco(const char* function) {
    return halflit::c::guarded(function, {}, [&]() -> halflit::Result<void> { return halflit::refuse(function); });
}
}  // namespace
int32_t halflit_mujoco_layout_init(halflit_mujoco_layout* /*layout*/, size_t /*size*/) { return refuse_mujoco(__func__); }
int32_t halflit_mujoco_model_init(halflit_mujoco_model* /*model*/, size_t /*size*/) { return refuse_mujoco(__func__); }
int32_t halflit_mujoco_scene_init(halflit_mujoco_scene* /*scene*/, size_t /*size*/) { return refuse_mujoco(__func__); }
int32_t halflit_mujoco_picture_init(halflit_mujoco_picture* /*picture*/, size_t /*size*/) { return refuse_mujoco(__func__); }
int32_t halflit_mujoco_create(const halflit_mujoco_model* /*model*/, const char* /*look*/, const halflit_execution* /*execution*/,
                              halflit_mujoco** /*mujoco*/) {
    return refuse_mujoco(__func__);
}
int32_t halflit_mujoco_render(halflit_mujoco* /*mujoco*/, const halflit_mujoco_picture* /*pictures*/, int32_t /*count*/) {
    return refuse_mujoco(__func__);
}
void halflit_mujoco_destroy(halflit_mujoco* /*mujoco*/) {}
