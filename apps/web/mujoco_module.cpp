// The part of the module for pictures of MuJoCo's scenes, which package/mujoco.js calls. JavaScript copies model and scene into this
// module's memory, by the tables that halflit_mujoco_tables() prints.
#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/mujoco/drawer.hpp"
#include "apps/web/module.hpp"
#include "halflit/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

using namespace halflit;
using namespace halflit::engine::mujoco;

namespace {

/// Arrays of a scene, and what their elements are: structs, or numbers. transform: enabletransform, translate, rotate, scale.
enum SceneArray { kGeoms, kLights, kCameras, kFlags, kTransform, kSkinVert, kSkinNormal, kFlexFaceUsed, kFlexFace, kFlexNormal };
constexpr struct {
    const char *name, *kind;
} kSceneArrays[] = {{"geoms", "geom"},      {"lights", "light"},    {"camera", "camera"},    {"flags", "uint8"},
                    {"transform", "float"}, {"skinvert", "float"},  {"skinnormal", "float"}, {"flexfaceused", "int32"},
                    {"flexface", "float"},  {"flexnormal", "float"}};
constexpr std::size_t kTransformNumbers = 9;

/// Types of geoms whose numbers differ among releases: mjGEOM_ and the name.
constexpr struct {
    const char* name;
    std::int32_t Layout::*number;
} kGeomTypes[] = {
    {"SKIN", &Layout::type_skin}, {"FLEX", &Layout::type_flex}, {"LINEBOX", &Layout::type_linebox}, {"TRIANGLE", &Layout::type_triangle}};

struct Mujoco {
    std::optional<Drawer> drawer;
    Layout layout;
    std::size_t skin_vertices = 0, flexes = 0, flex_faces = 0;
    std::array<std::vector<std::byte>, std::size(kSceneArrays)> arrays;
    std::vector<std::uint8_t> rgb;
    Image picture;
    std::vector<float> depth;
    std::vector<std::int32_t> object;
    std::string error, hash;

    template <class T>
    [[nodiscard]] const T* array(SceneArray which) const {
        return arrays[which].empty() ? nullptr : reinterpret_cast<const T*>(arrays[which].data());
    }
    /// True if an array has at least so many elements of a size.
    [[nodiscard]] bool has(SceneArray which, std::size_t count, std::size_t size) const { return arrays[which].size() / size >= count; }
    [[nodiscard]] bool is_empty_or(SceneArray which, std::size_t count, std::size_t size) const {
        return arrays[which].empty() || (arrays[which].size() % size == 0 && arrays[which].size() / size == count);
    }
};

/// Converts a number of JavaScript. Integers are clamped to T's range; NaN becomes 0.
template <class T>
T number_of(double value) {
    static_assert(sizeof(T) <= 4 || std::is_floating_point_v<T>);
    if constexpr (std::is_integral_v<T>) {
        if (std::isnan(value)) return 0;
        const double least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
        return static_cast<T>(std::clamp(value, least, most));
    } else {
        return static_cast<T>(value);
    }
}

template <class T>
constexpr const char* number_kind() {
    if constexpr (std::is_same_v<T, std::int32_t>)
        return "int32";
    else if constexpr (std::is_same_v<T, std::int64_t>)
        return "int64";
    else if constexpr (std::is_same_v<T, std::uint8_t>)
        return "uint8";
    else if constexpr (std::is_same_v<T, float>)
        return "float";
    else {
        static_assert(std::is_same_v<T, double>, "a type without a name in JavaScript");
        return "double";
    }
}

Result<void> draw(Mujoco& by, std::size_t geoms, std::size_t lights, Picture picture) {
    const auto size = [](std::int32_t bytes) { return static_cast<std::size_t>(bytes); };
    if (!by.has(kGeoms, geoms, size(by.layout.geom_size)) || !by.has(kLights, lights, size(by.layout.light_size)) ||
        !by.has(kCameras, 2, size(by.layout.camera_size)) || !by.has(kFlags, kFlagCount, 1) ||
        !by.has(kTransform, kTransformNumbers, sizeof(float)))
        return fail(ErrorCode::usage, "the scene's arrays are shorter than its counts say");
    if (!by.is_empty_or(kSkinVert, by.skin_vertices, 12) || !by.is_empty_or(kSkinNormal, by.skin_vertices, 12) ||
        !by.is_empty_or(kFlexFaceUsed, by.flexes, 4) || !by.is_empty_or(kFlexFace, by.flex_faces, 36) ||
        !by.is_empty_or(kFlexNormal, by.flex_faces, 36))
        return fail(ErrorCode::usage, "the scene has other skins or flexes than the renderer's model");
    engine::mujoco::Scene scene{.geoms = by.array<std::byte>(kGeoms),
                                .lights = by.array<std::byte>(kLights),
                                .camera = by.array<std::byte>(kCameras),
                                .flags = by.array<std::uint8_t>(kFlags),
                                .skinvert = by.array<float>(kSkinVert),
                                .skinnormal = by.array<float>(kSkinNormal),
                                .flexfaceused = by.array<std::int32_t>(kFlexFaceUsed),
                                .flexface = by.array<float>(kFlexFace),
                                .flexnormal = by.array<float>(kFlexNormal),
                                .ngeom = static_cast<std::int32_t>(geoms),
                                .nlight = static_cast<std::int32_t>(lights)};
    const float* const transform = by.array<float>(kTransform);
    scene.enabletransform = transform[0] != 0;
    std::copy_n(transform + 1, 3, scene.translate);
    std::copy_n(transform + 4, 4, scene.rotate);
    scene.scale = transform[8];
    picture.scene = &scene;
    return by.drawer->render({&picture, 1});
}

}  // namespace

extern "C" {

/// Tables of what JavaScript copies, one entry a line:
/// "geom pos float 3": a member of mjvGeom, mjvLight or mjvGLCamera; "number znear", "count nmesh": of mjModel;
/// "array mesh_vert nmeshvert float 3": one of mjModel's arrays, three numbers for each of nmeshvert;
/// "type SKIN", "flag SHADOW": constants; "scene skinvert float": an array of mjvScene, whose index is that of its line.
EMSCRIPTEN_KEEPALIVE const char* halflit_mujoco_tables() {
    static const std::string rows = [] {
        std::string text;
        const auto member = [&](std::string_view name, const char* kind, int count) {
            const std::size_t cut = name.find('_');
            text += fmt::format("{} {} {} {}\n", name.substr(0, cut), name.substr(cut + 1), kind, count);
        };
#define MEMBER(type, name, count, whole, place, is_needed) member(#name, number_kind<type>(), count);
#include "apps/engine/mujoco/layout_members.def"
#define NUMBER(type, name, value) text += "number " #name "\n";
#define COUNT(name) text += "count " #name "\n";
#define ARRAY(type, name, count, each) text += fmt::format("array " #name " " #count " {} {}\n", number_kind<type>(), each);
#include "apps/engine/mujoco/model_members.def"
        for (const auto& type : kGeomTypes) text += fmt::format("type {}\n", type.name);
        for (const std::string_view flag : kFlagNames) text += fmt::format("flag {}\n", flag);
        for (const auto& array : kSceneArrays) text += fmt::format("scene {} {}\n", array.name, array.kind);
        return text;
    }();
    return rows.c_str();
}

EMSCRIPTEN_KEEPALIVE Mujoco* halflit_mujoco_open() { return new Mujoco; }
EMSCRIPTEN_KEEPALIVE void halflit_mujoco_close(Mujoco* mujoco) { delete mujoco; }
EMSCRIPTEN_KEEPALIVE const char* halflit_mujoco_error(const Mujoco* mujoco) { return mujoco->error.c_str(); }

/// Makes shapes and textures. places: sizes of mjvGeom, mjvLight and mjvGLCamera, the bytes where each member of the tables is, -1 for
/// none, and the numbers of the types. numbers: the tables' numbers and counts, ntexdata, the colors of fog and haze. arrays: the tables',
/// as long as the counts say.
EMSCRIPTEN_KEEPALIVE int halflit_mujoco_read(Mujoco* mujoco, const std::int32_t* places, const double* numbers, const void* const* arrays,
                                             const char* release) {
    return web::attempt(mujoco->error, [&]() -> Result<void> {
        const auto look = look_of(release);
        if (!look) return tl::unexpected(look.error());
        Model model;
        Layout& layout = model.layout;
        layout.geom_size = *places++, layout.light_size = *places++, layout.camera_size = *places++;
#define MEMBER(type, name, count, whole, place, is_needed) layout.name = *places++;
#include "apps/engine/mujoco/layout_members.def"
        for (const auto& type : kGeomTypes) layout.*type.number = *places++;
#define NUMBER(type, name, value) model.name = number_of<type>(*numbers++);
#define COUNT(name) model.name = number_of<std::int32_t>(*numbers++);
#define ARRAY(type, name, count, each) model.name = static_cast<const type*>(*arrays++);
#include "apps/engine/mujoco/model_members.def"
        model.ntexdata = number_of<std::uint32_t>(*numbers++);
        for (float* const color : {model.fog_rgba, model.haze_rgba})
            for (int k = 0; k < 4; ++k) color[k] = number_of<float>(*numbers++);
        auto drawer = Drawer::make(model, *look, Execution{.threads = 1});
        if (!drawer) return tl::unexpected(drawer.error());
        mujoco->drawer = std::move(*drawer);
        mujoco->layout = layout;
        mujoco->skin_vertices = static_cast<std::size_t>(model.nskinvert), mujoco->flexes = static_cast<std::size_t>(model.nflex);
        mujoco->flex_faces = static_cast<std::size_t>(std::accumulate(model.flex_facenum, model.flex_facenum + model.nflex, 0));
        return {};
    });
}

/// Memory for an array of the scene, which the caller fills. Null: out of memory, or bytes is 0.
EMSCRIPTEN_KEEPALIVE void* halflit_mujoco_array(Mujoco* mujoco, std::uint32_t which, std::uint32_t bytes) {
    try {
        std::vector<std::byte>& array = mujoco->arrays.at(which);
        array.resize(bytes);
        return array.data();
    } catch (const std::bad_alloc&) {
        return nullptr;
    } catch (const std::length_error&) {
        return nullptr;
    }
}

/// Draws the scene of the arrays; rgb, depth, segmentation: not 0 for colors, distances, and objid and objtype.
EMSCRIPTEN_KEEPALIVE int halflit_mujoco_draw(Mujoco* mujoco, std::uint32_t geoms, std::uint32_t lights, int width, int height, int samples,
                                             int rgb, int depth, int segmentation) {
    return web::attempt(mujoco->error, [&]() -> Result<void> {
        Picture picture{.width = width, .height = height, .samples = samples, .depth_is_distance = true};
        if (auto ok = check_size(picture); !ok) return ok;
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        mujoco->rgb.resize(rgb != 0 ? 3 * pixels : 0);
        mujoco->depth.resize(depth != 0 ? pixels : 0);
        mujoco->object.resize(segmentation != 0 ? 2 * pixels : 0);
        picture.rgb = rgb != 0 ? mujoco->rgb.data() : nullptr;
        picture.depth = depth != 0 ? mujoco->depth.data() : nullptr;
        picture.object = segmentation != 0 ? mujoco->object.data() : nullptr;
        if (auto ok = draw(*mujoco, geoms, lights, picture); !ok || rgb == 0) return ok;
        if (mujoco->picture.width != width || mujoco->picture.height != height) mujoco->picture = Image::make(width, height);
        for (std::size_t i = 0; i < pixels; ++i) {
            std::copy_n(mujoco->rgb.data() + 3 * i, 3, mujoco->picture.rgba8.data() + 4 * i);
            mujoco->picture.rgba8[4 * i + 3] = 255;
        }
        mujoco->hash = engine::hash_text(mujoco->picture.rgba8);
        return {};
    });
}
EMSCRIPTEN_KEEPALIVE const char* halflit_mujoco_hash(const Mujoco* mujoco) { return mujoco->hash.c_str(); }
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_mujoco_pixels(const Mujoco* mujoco) { return mujoco->picture.rgba8.data(); }
EMSCRIPTEN_KEEPALIVE const float* halflit_mujoco_depth(const Mujoco* mujoco) { return mujoco->depth.data(); }
EMSCRIPTEN_KEEPALIVE const std::int32_t* halflit_mujoco_segmentation(const Mujoco* mujoco) { return mujoco->object.data(); }

}  // extern "C"
