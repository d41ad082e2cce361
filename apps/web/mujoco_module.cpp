// The part of the module for pictures of MuJoCo's scenes, which package/mujoco.js calls. It copies what scene and model hold into this
// module's memory, by the tables that halflit_mujoco_tables() tells.
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

using namespace halflit;
using namespace halflit::engine::mujoco;

namespace {

/// Arrays of a scene. transform: enabletransform, translate, rotate, scale, as floats.
enum SceneArray {
    kGeoms,
    kLights,
    kCameras,
    kFlags,
    kTransform,
    kSkinVert,
    kSkinNormal,
    kFlexFaceUsed,
    kFlexFace,
    kFlexNormal,
    kSceneArrays
};
constexpr std::size_t kTransformNumbers = 9;

struct Mujoco {
    std::optional<Drawer> drawer;
    Layout layout;
    std::size_t skin_vertices = 0, flexes = 0, flex_faces = 0;
    std::array<std::vector<std::byte>, kSceneArrays> arrays;
    std::vector<std::uint8_t> rgb;
    Image picture;
    std::vector<float> depth;
    std::vector<std::int32_t> object;
    std::string text;  ///< an error's words, or the hash of the last picture

    template <class T>
    [[nodiscard]] const T* array(SceneArray which) const {
        return arrays[which].empty() ? nullptr : reinterpret_cast<const T*>(arrays[which].data());
    }
    [[nodiscard]] bool holds(SceneArray which, std::size_t count, std::size_t each) const {
        return arrays[which].empty() || arrays[which].size() == count * each;
    }
};

/// A number of JavaScript as T. Whole ones that T has not become those nearest to them.
template <class T>
T number_of(double value) {
    if constexpr (std::is_integral_v<T>) {
        if (std::isnan(value)) return 0;
        const double least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
        return static_cast<T>(std::clamp(value, least, most));
    } else {
        return static_cast<T>(value);
    }
}

template <class T>
constexpr const char* number_kind = "";
template <>
constexpr const char* number_kind<std::int32_t> = "int32";
template <>
constexpr const char* number_kind<std::int64_t> = "int64";
template <>
constexpr const char* number_kind<std::uint8_t> = "uint8";
template <>
constexpr const char* number_kind<float> = "float";
template <>
constexpr const char* number_kind<double> = "double";

Result<void> draw(Mujoco& by, std::size_t geoms, std::size_t lights, Picture picture) {
    const auto size = [](std::int32_t bytes) { return static_cast<std::size_t>(bytes); };
    if (by.arrays[kGeoms].size() < geoms * size(by.layout.geom_size) || by.arrays[kLights].size() < lights * size(by.layout.light_size) ||
        by.arrays[kCameras].size() < 2 * size(by.layout.camera_size) || by.arrays[kFlags].size() < kFlagCount ||
        by.arrays[kTransform].size() < kTransformNumbers * sizeof(float))
        return fail(ErrorCode::usage, "the scene's arrays are shorter than its counts say");
    if (!by.holds(kSkinVert, by.skin_vertices, 12) || !by.holds(kSkinNormal, by.skin_vertices, 12) ||
        !by.holds(kFlexFaceUsed, by.flexes, 4) || !by.holds(kFlexFace, by.flex_faces, 36) || !by.holds(kFlexNormal, by.flex_faces, 36))
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

/// What is copied, one a line. "geom pos float 3": a member of mjvGeom, mjvLight or mjvGLCamera. "number znear", "count nmesh": of mjModel.
/// "array mesh_vert nmeshvert float 3": one of its arrays, three for each of nmeshvert.
EMSCRIPTEN_KEEPALIVE const char* halflit_mujoco_tables() {
    static const std::string rows = [] {
        std::string text;
        const auto member = [&](std::string_view name, const char* kind, int count) {
            const std::size_t cut = name.find('_');
            text += fmt::format("{} {} {} {}\n", name.substr(0, cut), name.substr(cut + 1), kind, count);
        };
#define MEMBER(type, name, count, whole, place, is_needed) member(#name, number_kind<type>, count);
#include "apps/engine/mujoco/layout_members.def"
#define NUMBER(type, name, value) text += "number " #name "\n";
#define COUNT(name) text += "count " #name "\n";
#define ARRAY(type, name, count, each) text += fmt::format("array " #name " " #count " {} {}\n", number_kind<type>, each);
#include "apps/engine/mujoco/model_members.def"
        return text;
    }();
    return rows.c_str();
}

EMSCRIPTEN_KEEPALIVE Mujoco* halflit_mujoco_open() { return new Mujoco; }
EMSCRIPTEN_KEEPALIVE void halflit_mujoco_close(Mujoco* mujoco) { delete mujoco; }
EMSCRIPTEN_KEEPALIVE const char* halflit_mujoco_text(const Mujoco* mujoco) { return mujoco->text.c_str(); }

/// Makes shapes and textures. places: sizes of mjvGeom, mjvLight and mjvGLCamera, then the bytes of each member in the table's order, -1
/// for none, then the numbers of skins, flexes, line boxes and triangles in mjtGeom. numbers: the table's, then ntexdata and the colors of
/// fog and haze. arrays: the table's; their lengths are as the counts say.
EMSCRIPTEN_KEEPALIVE int halflit_mujoco_read(Mujoco* mujoco, const std::int32_t* places, const double* numbers, const void* const* arrays,
                                             const char* release) {
    return web::attempt(mujoco->text, [&]() -> Result<void> {
        const auto look = look_of(release);
        if (!look) return tl::unexpected(look.error());
        Model model;
        Layout& layout = model.layout;
        layout.geom_size = *places++, layout.light_size = *places++, layout.camera_size = *places++;
#define MEMBER(type, name, count, whole, place, is_needed) layout.name = *places++;
#include "apps/engine/mujoco/layout_members.def"
        layout.type_skin = places[0], layout.type_flex = places[1], layout.type_linebox = places[2], layout.type_triangle = places[3];
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

/// Memory for an array of the scene, which the caller fills. Null: there is none.
EMSCRIPTEN_KEEPALIVE void* halflit_mujoco_array(Mujoco* mujoco, int which, int bytes) {
    try {
        auto& array = mujoco->arrays.at(static_cast<std::size_t>(which));
        array.resize(static_cast<std::size_t>(bytes));
        return array.data();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

/// Draws the scene of the arrays; depth, segmentation: not 0 for distances, and for objid and objtype.
EMSCRIPTEN_KEEPALIVE int halflit_mujoco_draw(Mujoco* mujoco, int geoms, int lights, int width, int height, int samples, int depth,
                                             int segmentation) {
    return web::attempt(mujoco->text, [&]() -> Result<void> {
        const std::int64_t area = std::int64_t{width} * height;
        if (width < 1 || height < 1 || area > std::int64_t{1} << 28)
            return fail(ErrorCode::usage, fmt::format("picture: {} x {} pixels", width, height));
        const auto pixels = static_cast<std::size_t>(area);
        mujoco->rgb.resize(3 * pixels);
        mujoco->depth.resize(depth != 0 ? pixels : 0);
        mujoco->object.resize(segmentation != 0 ? 2 * pixels : 0);
        const auto data = [](auto& plane) { return plane.empty() ? nullptr : plane.data(); };
        const Picture picture{.rgb = mujoco->rgb.data(),
                              .depth = data(mujoco->depth),
                              .object = data(mujoco->object),
                              .width = width,
                              .height = height,
                              .samples = samples,
                              .depth_is_distance = true};
        const auto count = [](int given) { return static_cast<std::size_t>(std::max(0, given)); };
        if (auto ok = draw(*mujoco, count(geoms), count(lights), picture); !ok) return ok;
        if (mujoco->picture.width != width || mujoco->picture.height != height) mujoco->picture = Image::make(width, height);
        for (std::size_t i = 0; i < pixels; ++i) {
            std::copy_n(mujoco->rgb.data() + 3 * i, 3, mujoco->picture.rgba8.data() + 4 * i);
            mujoco->picture.rgba8[4 * i + 3] = 255;
        }
        mujoco->text = engine::hash_text(mujoco->picture.rgba8);
        return {};
    });
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_mujoco_pixels(const Mujoco* mujoco) { return mujoco->picture.rgba8.data(); }
EMSCRIPTEN_KEEPALIVE const float* halflit_mujoco_depth(const Mujoco* mujoco) { return mujoco->depth.data(); }
EMSCRIPTEN_KEEPALIVE const std::int32_t* halflit_mujoco_segmentation(const Mujoco* mujoco) { return mujoco->object.data(); }

}  // extern "C"
