// Functions of halflit.h that draw scenes of MuJoCo.
#include "apps/c/boundary.hpp"
#include "apps/c/convert.hpp"
#include "apps/c/interrupt.hpp"
#include "apps/c/versioned.hpp"
#include "apps/engine/mujoco/drawer.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

using namespace halflit;
using namespace halflit::c;
using engine::mujoco::Drawer;

struct halflit_mujoco {
    Drawer drawer;
    Execution execution;
    bool stops_at_interrupt = false;
    std::atomic<bool> busy{false};
};

namespace {

HALFLIT_ENDS_WITH(halflit_mujoco_layout, type_triangle);
HALFLIT_ENDS_WITH(halflit_mujoco_model, flex_facenum);
HALFLIT_ENDS_WITH(halflit_mujoco_scene, reserved);
HALFLIT_ENDS_WITH(halflit_mujoco_picture, depth_pass);

halflit_mujoco_layout default_layout() {
    const engine::mujoco::Layout from;
    halflit_mujoco_layout to{};
    to.size = sizeof to;
#define WHOLE(name, bytes) to.name = from.name;
#define MEMBER(type, name, count, whole, place, is_needed) to.name = from.name;
#include "apps/engine/mujoco/layout_members.def"
    to.type_skin = from.type_skin, to.type_flex = from.type_flex;
    to.type_linebox = from.type_linebox, to.type_triangle = from.type_triangle;
    return to;
}

halflit_mujoco_model default_model() {
    const engine::mujoco::Model from;
    halflit_mujoco_model to{};
    to.size = sizeof to;
#define NUMBER(type, name, value) to.name = from.name;
#include "apps/engine/mujoco/model_members.def"
    std::copy_n(from.fog_rgba, 4, to.fog_rgba);
    std::copy_n(from.haze_rgba, 4, to.haze_rgba);
    return to;
}

halflit_mujoco_scene default_scene() {
    halflit_mujoco_scene to{};
    to.size = sizeof to;
    to.rotate[0] = to.scale = 1;
    return to;
}

halflit_mujoco_picture default_picture() {
    halflit_mujoco_picture to{};
    to.size = sizeof to;
    to.samples = 1;
    return to;
}

Result<engine::mujoco::Model> read_model(const halflit_mujoco_model* given) {
    const auto model = read_struct(given, default_model(), "halflit_mujoco_model");
    if (!model) return tl::unexpected<Error>(model.error());
    engine::mujoco::Model to;
#define NUMBER(type, name, value) to.name = model->name;
#define COUNT(name) to.name = model->name;
#define ARRAY(type, name, count, each) to.name = model->name;
#include "apps/engine/mujoco/model_members.def"
    to.ntexdata = model->ntexdata;
    std::copy_n(model->fog_rgba, 4, to.fog_rgba);
    std::copy_n(model->haze_rgba, 4, to.haze_rgba);
    if (model->layout == nullptr) return to;
    const auto layout = read_struct(model->layout, default_layout(), "halflit_mujoco_layout");
    if (!layout) return tl::unexpected<Error>(layout.error());
#define WHOLE(name, bytes) to.layout.name = layout->name;
#define MEMBER(type, name, count, whole, place, is_needed) to.layout.name = layout->name;
#include "apps/engine/mujoco/layout_members.def"
    to.layout.type_skin = layout->type_skin, to.layout.type_flex = layout->type_flex;
    to.layout.type_linebox = layout->type_linebox, to.layout.type_triangle = layout->type_triangle;
    return to;
}

Result<engine::mujoco::Scene> read_scene(const halflit_mujoco_scene* given) {
    if (given == nullptr) return fail(ErrorCode::usage, "halflit_mujoco_picture: scene is null");
    const auto scene = read_struct(given, default_scene(), "halflit_mujoco_scene");
    if (!scene) return tl::unexpected<Error>(scene.error());
    engine::mujoco::Scene to{.geoms = static_cast<const std::byte*>(scene->geoms),
                             .lights = static_cast<const std::byte*>(scene->lights),
                             .camera = static_cast<const std::byte*>(scene->camera),
                             .flags = scene->flags,
                             .skinvert = scene->skinvert,
                             .skinnormal = scene->skinnormal,
                             .flexfaceused = scene->flexfaceused,
                             .flexface = scene->flexface,
                             .flexnormal = scene->flexnormal,
                             .ngeom = scene->ngeom,
                             .nlight = scene->nlight,
                             .enabletransform = scene->enabletransform != 0,
                             .scale = scene->scale};
    std::copy_n(scene->translate, 3, to.translate);
    std::copy_n(scene->rotate, 4, to.rotate);
    return to;
}

Result<engine::mujoco::Picture> read_picture(const halflit_mujoco_picture* given) {
    const auto from = read_struct(given, default_picture(), "halflit_mujoco_picture");
    if (!from) return tl::unexpected<Error>(from.error());
    if (from->depth_unit < 0 || from->depth_unit > HALFLIT_MUJOCO_DEPTH_DISTANCE)
        return fail(ErrorCode::usage, "halflit_mujoco_picture: depth_unit is " + std::to_string(from->depth_unit) + ", expected 0 or 1");
    if (from->depth_pass < 0 || from->depth_pass > HALFLIT_MUJOCO_PASS_COLOR)
        return fail(ErrorCode::usage, "halflit_mujoco_picture: depth_pass is " + std::to_string(from->depth_pass) + ", expected 0 or 1");
    return engine::mujoco::Picture{.scene = nullptr,
                                   .camera = static_cast<const std::byte*>(from->camera),
                                   .flags = from->flags,
                                   .rgb = from->rgb,
                                   .depth = from->depth,
                                   .segid = from->segid,
                                   .object = from->object,
                                   .width = from->width,
                                   .height = from->height,
                                   .samples = from->samples,
                                   .bottom_up = from->bottom_up != 0,
                                   .depth_is_distance = from->depth_unit == HALFLIT_MUJOCO_DEPTH_DISTANCE,
                                   .depth_of_color_pass = from->depth_pass == HALFLIT_MUJOCO_PASS_COLOR};
}

Result<void> draw(halflit_mujoco& by, const halflit_mujoco_picture* given, std::int32_t count) {
    if (count < 0) return fail(ErrorCode::usage, "halflit_mujoco_render: count is " + std::to_string(count));
    if (count > 0)
        if (auto ok = check_size(given->size, sizeof *given, "halflit_mujoco_picture"); !ok) return ok;
    std::vector<engine::mujoco::Scene> scenes(static_cast<std::size_t>(count));
    std::vector<engine::mujoco::Picture> pictures;
    for (std::int32_t i = 0; i < count; ++i) {
        auto picture = read_picture(at(given, i));
        if (!picture) return tl::unexpected<Error>(picture.error());
        auto scene = read_scene(at(given, i)->scene);
        if (!scene) return tl::unexpected<Error>(scene.error());
        scenes[static_cast<std::size_t>(i)] = *scene;
        picture->scene = &scenes[static_cast<std::size_t>(i)];
        pictures.push_back(*picture);
    }
    const InterruptWatch watch(by.stops_at_interrupt);
    by.drawer.set_execution(watch.stopping(by.execution));
    return by.drawer.render(pictures);
}

}  // namespace

int32_t halflit_mujoco_layout_init(halflit_mujoco_layout* layout, size_t size) {
    return guarded(__func__, {{layout, "layout"}}, [&] { return write_struct(default_layout(), size, layout, "halflit_mujoco_layout"); });
}
int32_t halflit_mujoco_model_init(halflit_mujoco_model* model, size_t size) {
    return guarded(__func__, {{model, "model"}}, [&] { return write_struct(default_model(), size, model, "halflit_mujoco_model"); });
}
int32_t halflit_mujoco_scene_init(halflit_mujoco_scene* scene, size_t size) {
    return guarded(__func__, {{scene, "scene"}}, [&] { return write_struct(default_scene(), size, scene, "halflit_mujoco_scene"); });
}
int32_t halflit_mujoco_picture_init(halflit_mujoco_picture* picture, size_t size) {
    return guarded(__func__, {{picture, "picture"}},
                   [&] { return write_struct(default_picture(), size, picture, "halflit_mujoco_picture"); });
}

int32_t halflit_mujoco_create(const halflit_mujoco_model* given, const char* look_name, const halflit_execution* given_execution,
                              halflit_mujoco** mujoco) {
    return guarded(__func__, {{given, "model"}, {look_name, "look"}, {mujoco, "mujoco"}}, [&]() -> Result<void> {
        const auto look = engine::mujoco::look_of(look_name);
        if (!look) return tl::unexpected<Error>(look.error());
        const auto how = execution(given_execution);
        if (!how) return tl::unexpected<Error>(how.error());
        const auto model = read_model(given);
        if (!model) return tl::unexpected<Error>(model.error());
        auto drawer = Drawer::make(*model, *look, *how);
        if (!drawer) return tl::unexpected<Error>(drawer.error());
        *mujoco = new halflit_mujoco{std::move(*drawer), *how, stops_at_interrupt(given_execution)};
        return {};
    });
}

int32_t halflit_mujoco_render(halflit_mujoco* mujoco, const halflit_mujoco_picture* pictures, int32_t count) {
    if (mujoco == nullptr) return record_failure(ErrorCode::usage, __func__, "mujoco is null");
    if (mujoco->busy.exchange(true)) return record_failure(ErrorCode::usage, __func__, "another call draws with it");
    const std::int32_t code = guarded(__func__, {{pictures, "pictures"}}, [&] { return draw(*mujoco, pictures, count); });
    mujoco->busy = false;
    return code;
}

void halflit_mujoco_destroy(halflit_mujoco* mujoco) { delete mujoco; }
