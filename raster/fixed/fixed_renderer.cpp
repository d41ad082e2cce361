// The steps of a fixed-function frame.
#include "halflit/fixed_function.hpp"

#include "raster/check_execution.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/fixed/fixed_pass.hpp"
#include "raster/fixed/projection.hpp"
#include "raster/view/culling.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace halflit {

using namespace raster;

namespace {

constexpr int kMostSide = 16384;  // of pictures, textures and shadow maps: within the guard band
constexpr float kMostExponent = 10000.0f;

/// Sides of items that are drawn: both of those that ask for it, or the same of all.
enum class Sides { as_asked, one, both };

/// Materials of instances: how their stages are drawn, and whether both sides are.
enum Kind : int { kSolid, kSolidBoth, kBackdrop, kBackdropBoth, kLayer, kLayerBoth, kKinds };
int kind_of(const FixedItem& item, bool culls) {
    const int stage = item.stage == FixedStage::solid ? kSolid : item.stage == FixedStage::backdrop ? kBackdrop : kLayer;
    return stage + (item.both_sides || !culls ? 1 : 0);
}

Result<void> check_textures(const std::vector<CodeTexture>& textures) {
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const CodeTexture& t = textures[i];
        const auto texels = static_cast<std::size_t>(std::max(t.width, 0)) * static_cast<std::size_t>(std::max(t.height, 0));
        if (t.width < 1 || t.height < 1 || t.width > kMostSide || t.height > kMostSide || (t.cube && t.width != t.height) ||
            t.rgb.size() != 3 * texels * (t.cube ? 6 : 1) || texels > (std::size_t{1} << 27))
            return fail(ErrorCode::bad_input, "texture " + std::to_string(i) + ": its size and its codes do not agree");
    }
    return {};
}

Result<void> check_frame(const FixedFrame& frame) {
    const FixedCamera& camera = frame.camera;
    for (const float side : {camera.left, camera.right, camera.bottom, camera.top, camera.near_z, camera.far_z})
        if (!finite(side)) return fail(ErrorCode::usage, "the camera's frustum is not finite");
    if (!(camera.near_z > 0.0f) || !(camera.far_z > camera.near_z) || !(camera.right > camera.left) || !(camera.top > camera.bottom))
        return fail(ErrorCode::usage, "the camera's frustum has no size");
    if (!(frame.line_width >= 0.0625f && frame.line_width <= 256.0f)) return fail(ErrorCode::usage, "lines are 1/16 to 256 pixels wide");
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const FixedLight& light = frame.lights[i];
        const auto failed = [&](const char* what) { return fail(ErrorCode::bad_input, "light " + std::to_string(i) + ": " + what); };
        if (light.shadow_size != 0 && (light.shadow_size < 4 || light.shadow_size > kMostSide))
            return failed("its shadow map has 4 to 16384 texels on a side, or 0");
        if (!(light.exponent >= 0.0f && light.exponent <= kMostExponent)) return failed("its exponent is from 0 to 10000");
    }
    for (std::size_t i = 0; i < frame.items.size(); ++i)
        if (const float n = frame.items[i].material.shininess; !(n >= 0.0f && n <= kMostExponent))
            return fail(ErrorCode::bad_input, "item " + std::to_string(i) + ": its shininess is from 0 to 10000");
    return {};
}

Vec3f normal_of(const FixedMirror& mirror) { return normalize_or(mirror.normal_ws, {0, 0, 1}); }

Mat4 reflection(const FixedMirror& mirror) {
    const Vec3f n = normal_of(mirror);
    const float distance = dot(n, mirror.point_ws);
    Mat4 m;
    m.c[0] = {1 - 2 * n.x * n.x, -2 * n.x * n.y, -2 * n.x * n.z, 0};
    m.c[1] = {-2 * n.y * n.x, 1 - 2 * n.y * n.y, -2 * n.y * n.z, 0};
    m.c[2] = {-2 * n.z * n.x, -2 * n.z * n.y, 1 - 2 * n.z * n.z, 0};
    m.c[3] = {2 * distance * n.x, 2 * distance * n.y, 2 * distance * n.z, 1};
    return m;
}

Frustum frustum_of(const FixedCamera& camera) {
    return {camera.left, camera.right, camera.bottom, camera.top, camera.near_z, camera.far_z, camera.parallel};
}

}  // namespace

struct FixedFunctionRenderer::Impl {
    Scene scene;
    std::vector<std::shared_ptr<const CodeLevelsData>> textures;  ///< shared with copies
    std::optional<PreparedData> prepared;
    Executor executor;
    Pool<TileScratch> scratch;
    FixedPass picture, mirrored;
    ViewGeometry planes;
    struct OfLight {
        Executor serial;  ///< a host's loop does not run in itself
        LightOcclusion occlusion;
    };
    std::vector<std::unique_ptr<OfLight>> lights;  ///< of each light with shadows
    SampleImage image, in_mirror;
    bool stale = false;  ///< a mesh was changed and not prepared

    Result<void> begin(const FixedFrame& frame);
    Result<void> draw(const FixedFrame& frame, const FixedTarget& target, Isa isa, const Execution& one_thread);
    /// Makes the items visible for which is_seen is true, each as its stage is drawn or all as opaque ones. Each pass begins with it, so
    /// that one that was stopped leaves nothing behind.
    template <class IsSeen>
    void show(const FixedFrame& frame, bool by_stages, Sides sides, const IsSeen& is_seen);
    Result<void> draw_mirror(const FixedContext& context, const View& view, const Mat4& clip_from_camera, const Mat4& camera_from_world);
};

Result<void> FixedFunctionRenderer::Impl::begin(const FixedFrame& frame) {
    for (std::size_t i = 0; i < frame.items.size(); ++i) {
        const FixedMaterial& material = frame.items[i].material;
        if (material.texture < -1 || (material.texture >= 0 && static_cast<std::size_t>(material.texture) >= textures.size()))
            return fail(ErrorCode::bad_input, "item " + std::to_string(i) + " names texture " + std::to_string(material.texture) + " of " +
                                                  std::to_string(textures.size()));
    }
    scene.instances.resize(frame.items.size());
    for (std::size_t i = 0; i < frame.items.size(); ++i) {
        Instance& instance = scene.instances[i];
        instance.mesh = frame.items[i].mesh;
        instance.material = kind_of(frame.items[i], frame.culls_faces);
        instance.world_from_object = frame.items[i].world_from_object;
        instance.visible = true;
    }
    return prepared->place_instances();
}

template <class IsSeen>
void FixedFunctionRenderer::Impl::show(const FixedFrame& frame, bool by_stages, Sides sides, const IsSeen& is_seen) {
    for (int k = 0; k < kKinds; ++k) {
        Material& material = scene.materials[static_cast<std::size_t>(k)];
        material.alpha_mode = !by_stages || k < kBackdrop ? AlphaMode::opaque : k < kLayer ? AlphaMode::mask : AlphaMode::blend;
        material.double_sided = sides == Sides::both || (sides == Sides::as_asked && k % 2 == 1);
    }
    for (std::size_t i = 0; i < frame.items.size(); ++i) scene.instances[i].visible = is_seen(frame.items[i]);
}

/// Draws the scene on the other side of the mirror, for the pixels that show it.
Result<void> FixedFunctionRenderer::Impl::draw_mirror(const FixedContext& context, const View& view, const Mat4& clip_from_camera,
                                                      const Mat4& camera_from_world) {
    const FixedFrame& frame = context.frame;
    const FixedMirror& mirror = frame.mirror;
    const Mat4 reflected = multiply_in_double(camera_from_world, reflection(mirror));
    View in = view;
    in.clip_from_world = multiply_in_double(clip_from_camera, reflected);
    // The mirror's plane takes the place of the near plane: clip z is w less a share of the distance from it, which never reaches w.
    const Vec3f n = normal_of(mirror);
    const float offset = -dot(n, mirror.point_ws), row[4] = {n.x, n.y, n.z, offset};
    const double wide = std::max({std::abs(double{frame.camera.left}), std::abs(double{frame.camera.right}),
                                  std::abs(double{frame.camera.top}), std::abs(double{frame.camera.bottom})}) /
                        frame.camera.near_z;
    const double share = frame.camera.parallel ? 1e-6 : 0.25 / (1.0 + wide);
    for (int k = 0; k < 4; ++k) in.clip_from_world.c[k].z = static_cast<float>(in.clip_from_world.c[k].w - share * double{row[k]});
    in.mirrored = true;
    set_region(in, picture.mirror_region());
    show(frame, true, Sides::as_asked, [](const FixedItem& item) {
        return item.in_mirror && !item.mirrors && (item.stage == FixedStage::solid || item.stage == FixedStage::transparent);
    });
    const float height = dot(n, frame.eye_ws) + offset;
    const VertexLight light(frame, reflected, in.clip_from_world, frame.eye_ws - n * (2.0f * height), false, mirror.reflectance);
    if (auto ok = mirrored.shade(context, in, light, {}, nullptr); !ok) return ok;
    mirrored.compose(context, nullptr, in_mirror);
    return {};
}

Result<void> FixedFunctionRenderer::Impl::draw(const FixedFrame& frame, const FixedTarget& target, Isa isa, const Execution& one_thread) {
    if (auto ok = begin(frame); !ok) return ok;
    const FixedContext context{frame, *prepared, textures, raster_kernels(isa), executor, scratch};
    const Mat4 camera_from_world = view_from_world(frame.camera.position_ws, frame.camera.forward_ws, frame.camera.up_ws);
    const Mat4 clip_from_camera = clip_from_view(frustum_of(frame.camera));
    View view = make_view(multiply_in_double(clip_from_camera, camera_from_world), target.width, target.height, {}, kMaxTileSize, 1);
    view.line_width = static_cast<int>(frame.line_width * 256.0f);
    const auto any = [&](const auto& is) { return std::any_of(frame.items.begin(), frame.items.end(), is); };

    // Depth and ids are those of the picture's own triangles where the same items are drawn, once a pixel.
    const bool has_planes = target.depth != nullptr || target.ids != nullptr;
    if (target.depth != nullptr && target.backdrop_depth && (target.rgb == nullptr || target.samples != 1 || target.ids != nullptr))
        return fail(ErrorCode::usage, "the depth of backdrops comes with rgb of one sample, and without ids");
    const bool others = !target.backdrop_depth && any([&](const FixedItem& item) {
        return (item.stage == FixedStage::solid && !item.in_planes) || item.stage == FixedStage::transparent;
    });
    const bool alone = has_planes && (target.rgb == nullptr || target.samples != 1 || others);
    if (alone) {
        show(frame, false, Sides::as_asked, [&](const FixedItem& item) {
            return item.in_planes && (item.stage == FixedStage::solid || item.stage == FixedStage::transparent);
        });
        if (auto ok = draw_planes(context, view, planes, target); !ok) return ok;
    }
    if (target.rgb == nullptr) return {};

    view.samples = make_view(view.clip_from_world, target.width, target.height, {}, kMaxTileSize, target.samples).samples;
    for (std::int16_t& y : view.samples.y) y = static_cast<std::int16_t>(-y);  // OpenGL's windows have y up
    show(frame, true, Sides::as_asked, [](const FixedItem&) { return true; });
    const VertexLight light(frame, camera_from_world, view.clip_from_world, frame.eye_ws, true, 1.0f);
    std::vector<LightMap> maps;
    for (const std::size_t i : light.shadowed()) maps.emplace_back(frame.lights[i]);
    if (auto ok = picture.shade(context, view, light, maps, has_planes && !alone ? &target : nullptr); !ok) return ok;

    if (!maps.empty()) {
        // All cast, as opaque surfaces: one side of all, or both.
        const Sides sides = frame.culls_faces && frame.shadow.back_faces_alone ? Sides::one : Sides::both;
        show(frame, false, sides, [](const FixedItem& item) {
            return item.casts_shadow && (item.stage == FixedStage::solid || item.stage == FixedStage::transparent);
        });
        while (lights.size() < maps.size()) lights.push_back(std::make_unique<OfLight>());
        std::vector<Result<void>> of_lights(maps.size());
        executor.run(static_cast<int>(maps.size()), [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            lights[k]->serial.configure(one_thread);
            of_lights[k] = picture.find_shadows(context, lights[k]->serial, frame.shadow, i, maps[k], lights[k]->occlusion);
        });
        const auto failed = std::find_if(of_lights.begin(), of_lights.end(), [](const auto& result) { return !result; });
        if (failed != of_lights.end()) return *failed;
    }

    const bool mirrors = frame.has_mirror && picture.mirror_region().width > 0;
    if (mirrors)
        if (auto ok = draw_mirror(context, view, clip_from_camera, camera_from_world); !ok) return ok;
    picture.compose(context, mirrors ? &in_mirror : nullptr, image);

    const auto samples = static_cast<std::uint32_t>(target.samples);
    executor.run(target.height, [&](int y) {
        const int row = target.bottom_up ? target.height - 1 - y : y;
        std::uint8_t* to = target.rgb + 3 * static_cast<std::size_t>(row) * static_cast<std::size_t>(target.width);
        const std::uint32_t* from = image.codes.data() + image.index(0, y);
        for (int x = 0; x < target.width; ++x, to += 3, from += samples) {
            std::uint32_t red_blue = from[0] & 0xff00ff, green = from[0] >> 8 & 0xff;
            if (samples > 1) {
                for (std::uint32_t s = 1; s < samples; ++s) red_blue += from[s] & 0xff00ff, green += from[s] >> 8 & 0xff;
                red_blue = (red_blue + 0x20002) >> 2 & 0xff00ff, green = (green + 2) >> 2;  // the mean of four, rounded
            }
            to[0] = static_cast<std::uint8_t>(red_blue), to[1] = static_cast<std::uint8_t>(green),
            to[2] = static_cast<std::uint8_t>(red_blue >> 16);
        }
    });
    return {};
}

FixedFunctionRenderer::FixedFunctionRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FixedFunctionRenderer::~FixedFunctionRenderer() = default;
FixedFunctionRenderer::FixedFunctionRenderer(FixedFunctionRenderer&&) noexcept = default;
FixedFunctionRenderer& FixedFunctionRenderer::operator=(FixedFunctionRenderer&&) noexcept = default;

Result<FixedFunctionRenderer> FixedFunctionRenderer::make(std::vector<Mesh> meshes, std::vector<CodeTexture> textures,
                                                          const Execution& execution) {
    return guarded("preparing meshes and textures", execution, [&]() -> Result<FixedFunctionRenderer> {
        if (auto ok = check_textures(textures); !ok) return tl::unexpected<Error>(ok.error());
        auto impl = std::make_unique<Impl>();
        impl->scene.meshes = std::move(meshes);
        for (Mesh& mesh : impl->scene.meshes) mesh.material = -1;
        impl->scene.materials.resize(kKinds);
        for (const CodeTexture& texture : textures) impl->textures.push_back(std::make_shared<const CodeLevelsData>(texture));
        auto prepared = PreparedData::make_for_geometry(impl->scene, execution);
        if (!prepared) return tl::unexpected<Error>(prepared.error());
        impl->prepared = std::move(*prepared);
        return FixedFunctionRenderer(std::move(impl));
    });
}

Result<FixedFunctionRenderer> FixedFunctionRenderer::copy(const Execution& execution) const {
    return guarded("copying meshes", execution, [&]() -> Result<FixedFunctionRenderer> {
        auto made = make(impl_->scene.meshes, {}, execution);
        if (made) made->impl_->textures = impl_->textures;
        return made;
    });
}

Result<void> FixedFunctionRenderer::set_vertices(int mesh, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                                 const Execution& execution) {
    const auto index = static_cast<std::size_t>(mesh);
    if (mesh < 0 || index >= impl_->scene.meshes.size()) return fail(ErrorCode::usage, "there is no mesh " + std::to_string(mesh));
    Mesh& of = impl_->scene.meshes[index];
    if (positions.size() != of.positions.size() || normals.size() != of.normals.size())
        return fail(ErrorCode::usage, "mesh " + std::to_string(mesh) + " has " + std::to_string(of.positions.size()) + " positions and " +
                                          std::to_string(of.normals.size()) + " normals");
    std::copy(positions.begin(), positions.end(), of.positions.begin());
    std::copy(normals.begin(), normals.end(), of.normals.begin());
    impl_->stale = true;  // until its clusters are those of the new positions
    return guarded("preparing a mesh", execution, [&]() -> Result<void> {
        Executor executor;
        executor.configure(execution);
        auto done = impl_->prepared->deform(index, executor);
        impl_->stale = !done;
        return done;
    });
}

Result<void> FixedFunctionRenderer::render(const FixedFrame& frame, const FixedTarget& target, const Execution& execution) {
    const auto isa = check_execution(execution);
    if (!isa) return tl::unexpected<Error>(isa.error());
    if (target.width < 1 || target.height < 1 || target.width > kMostSide || target.height > kMostSide)
        return fail(ErrorCode::usage, "a picture has 1 to 16384 pixels on a side");
    if (target.samples != 1 && target.samples != 4) return fail(ErrorCode::usage, "a pixel has 1 or 4 samples");
    if (auto ok = check_frame(frame); !ok) return ok;
    if (impl_->stale) return fail(ErrorCode::usage, "the last change of a mesh failed, and has to be done again");
    return guarded("drawing a frame", execution, [&] {
        impl_->executor.configure(execution);
        Execution one_thread;
        one_thread.cancelled = execution.cancelled;
        one_thread.time_limit_s = execution.time_limit_s, one_thread.memory_limit = execution.memory_limit;
        return impl_->draw(frame, target, *isa, one_thread);
    });
}

}  // namespace halflit
