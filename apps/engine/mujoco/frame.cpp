#include "apps/engine/mujoco/frame.hpp"

#include "apps/engine/mujoco/geom_parts.hpp"
#include "apps/engine/mujoco/room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halflit::engine::mujoco {
namespace {

constexpr int kGlLights = 8;            // OpenGL's limit; later ones give no light
constexpr double kOpaque = 0.995;       // alpha from which a geom is opaque
constexpr float kSkyShare = 0.70f;      // radius of the sky, shares of the far plane's distance
constexpr float kWidestShadow = 160;    // degrees
constexpr std::int32_t kModelGeom = 5;  // mjOBJ_GEOM

/// Columns, rounded to float.
Mat4 matrix(Vec3d x, Vec3d y, Vec3d z, Vec3d origin) {
    const auto column = [](Vec3d v, float w) {
        return Vec4f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
    };
    Mat4 made;
    made.c[0] = column(x, 0), made.c[1] = column(y, 0), made.c[2] = column(z, 0), made.c[3] = column(origin, 1);
    return made;
}

bool is_behind(Vec3f from, Vec3f point, Vec3f normal) { return dot(from - point, normal) < 0; }

/// A sphere around the geom that holds it, as MuJoCo estimates it.
float bound_of(const Geom& g) {
    const Vec3f s = g.size;
    if (g.objtype == kModelGeom) return g.rbound;
    switch (g.type) {
        case kSphere:
            return s.x;
        case kCapsule:
            return s.x + s.z;
        case kCylinder:
            return std::sqrt(s.x * s.x + s.z * s.z);
        case kBox:
            return length(s);
        default:
            return std::max({s.x, s.y, s.z});
    }
}

class FrameMaker {
public:
    FrameMaker(const FrameModel& model, const Scene& scene, const FrameRequest& request)
        : model_(model), scene_(scene), request_(request) {}

    Result<SceneFrame> make() {
        for (int k = 0; k < kFlagCount; ++k) flags_[k] = (request_.flags != nullptr ? request_.flags : kDefaultFlags)[k] != 0;
        if (auto room = Room::of(scene_))
            room_ = *room;
        else
            return tl::unexpected<Error>(room.error());
        const auto camera = read_camera(model_.layout, request_.camera);
        if (!camera) return tl::unexpected<Error>(camera.error());
        set_camera(*camera);
        for (int i = 0; i < scene_.ngeom; ++i) {
            auto geom = read_geom(model_.layout, scene_, i, model_.materials, static_cast<int>(model_.cubes.size()));
            if (!geom) return tl::unexpected<Error>(geom.error());
            if (auto ok = check_geom(*geom, i, model_.numbers); !ok) return tl::unexpected<Error>(ok.error());
            made_.geoms.push_back(*geom);
        }
        made_.frame.culls_faces = flags_[kCullFace];
        made_.frame.adds_layers = flags_[kAdditive];
        made_.frame.line_width = 3 * model_.line_width;
        if (request_.pass == Pass::segment) {
            for (std::size_t i = made_.geoms.size(); i-- > 0;)
                if (made_.geoms[i].segid >= 0) add_items(i, FixedStage::solid);
            return std::move(made_);
        }
        find_mirror();
        if (request_.pass == Pass::color) add_lights();
        add_opaque();
        if (flags_[kSkybox] && model_.sky >= 0) add_sky();
        if (request_.pass == Pass::color) {
            const std::size_t opaque = made_.frame.items.size();
            add_transparent();
            // The segment pass draws later geoms over earlier ones. Here the mirror loses to all others, so it has to be the first geom.
            made_.has_segments = mirror_ <= 0 && made_.frame.items.size() == opaque;
        }
        if (flags_[kFog]) {
            made_.frame.fog_start = model_.fog_start / room_.unit(), made_.frame.fog_end = model_.fog_end / room_.unit();
            made_.frame.fog_color = model_.fog_color;
        }
        return std::move(made_);
    }

private:
    void set_camera(const Camera& from) {
        const float half = from.width > 0
                               ? from.width
                               : 0.5f * static_cast<float>(request_.width) / static_cast<float>(request_.height) * (from.top - from.bottom);
        head_ = room_.head_in_model(from.position);
        gaze_ = room_.direction_in_model(from.forward);
        made_.near_z = from.near_z, made_.far_z = from.far_z;
        FixedCamera& camera = made_.frame.camera;
        camera.position_ws = made_.frame.eye_ws = room_.point_in_model(from.position);
        camera.forward_ws = gaze_, camera.up_ws = room_.direction_in_model(from.up);
        camera.parallel = from.orthographic;
        const float unit = room_.unit();
        camera.left = (from.center - half) / unit, camera.right = (from.center + half) / unit;
        camera.bottom = from.bottom / unit, camera.top = from.top / unit;
        camera.near_z = from.near_z / unit, camera.far_z = from.far_z / unit;
    }

    [[nodiscard]] bool is_seen_from_behind(const Geom& g) const { return g.type == kPlane && is_behind(head_, g.position, g.axes[2]); }
    [[nodiscard]] bool is_transparent(const Geom& g) const { return static_cast<double>(g.rgba.w) < kOpaque || is_seen_from_behind(g); }

    /// The first opaque plane or box with reflectance is the only mirror; of a box it is the upper side.
    void find_mirror() {
        for (std::size_t i = 0; i < made_.geoms.size() && mirror_ < 0; ++i) {
            const Geom& g = made_.geoms[i];
            if ((g.type == kPlane || g.type == kBox) && g.reflectance > 0 && !is_transparent(g)) mirror_ = static_cast<int>(i);
        }
        if (mirror_ < 0 || !flags_[kReflection]) return;
        const Geom& g = made_.geoms[static_cast<std::size_t>(mirror_)];
        const Vec3f point = g.type == kBox ? g.position + g.axes[2] * g.size.z : g.position;
        if (is_behind(head_, point, g.axes[2])) return;
        made_.frame.has_mirror = true;
        made_.frame.mirror = {point, normalize_or(g.axes[2], {0, 0, 1}), g.reflectance};
        head_in_mirror_ = head_ - g.axes[2] * (2 * dot(head_ - point, g.axes[2]));
    }

    void add_lights() {
        const float unit = room_.unit();
        bool any = false;
        for (int i = 0; i < scene_.nlight; ++i) {
            Light from = read_light(model_.layout, scene_, i);
            if (from.kind == LightKind::none) continue;
            any = true;
            if (i >= kGlLights) continue;
            if (i == 0 && from.headlight) from.position = head_, from.direction = gaze_;
            FixedLight light{.position_ws = from.position,
                             .direction_ws = from.direction,
                             .directional = from.kind == LightKind::directional,
                             .ambient = from.ambient,
                             .diffuse = from.diffuse,
                             .specular = from.specular};
            if (!light.directional) {
                // Distances are the room's.
                const float factors[3] = {1, unit, unit * unit};
                for (int k = 0; k < 3; ++k) light.attenuation[k] = from.attenuation[k] * factors[k];
                light.cutoff_deg = from.cutoff >= 0 && from.cutoff <= 90 ? from.cutoff : 180.0f;  // OpenGL refuses others
                light.exponent = from.exponent >= 0 && from.exponent <= 128 ? from.exponent : 0.0f;
            }
            if (from.castshadow && flags_[kShadow]) {
                light.shadow_size = model_.shadow_size;
                light.shadow_fov_deg = std::min(2 * from.cutoff * model_.shadow_scale, kWidestShadow);
                light.shadow_half_width = model_.shadow_clip;
                light.shadow_near = made_.near_z, light.shadow_far = made_.far_z;
            }
            made_.frame.lights.push_back(light);
        }
        const Look& look = model_.look;
        if (look.counts_lights_alone ? !any : scene_.nlight == 0) made_.frame.ambient = 0.3f;
        made_.frame.shadow = {look.back_faces_alone && flags_[kCullFace], look.offset_factor, look.offset_units};
    }

    /// Of equal depths the first item stays here and the last geom there: the reverse of the mirror and then the others.
    void add_opaque() {
        for (std::size_t i = made_.geoms.size(); i-- > 0;)
            if (!is_transparent(made_.geoms[i]) && static_cast<int>(i) != mirror_) add_items(i, FixedStage::solid);
        if (mirror_ >= 0) add_items(static_cast<std::size_t>(mirror_), FixedStage::solid);
    }

    /// From front to back.
    void add_transparent() {
        std::vector<std::pair<float, std::size_t>> order;
        for (std::size_t i = 0; i < made_.geoms.size(); ++i) {
            const Geom& g = made_.geoms[i];
            if (!is_transparent(g)) continue;
            const float key = length(g.position - head_) - bound_of(g);
            order.emplace_back(g.type == kPlane || std::isnan(key) ? 1e10f : key, i);
        }
        std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [distance, i] : order) add_items(i, FixedStage::transparent);
    }

    void add_items(std::size_t index, FixedStage stage) {
        const Geom& g = made_.geoms[index];
        const bool is_mirror = static_cast<int>(index) == mirror_ && made_.frame.has_mirror, behind = is_seen_from_behind(g);
        const bool is_soft = g.type == kSkin || g.type == kFlex, is_line = g.type == kLine || g.type == kLineBox;
        FixedItem item;
        item.material = material_of(g, model_.cubes, model_.look.shapes_have_uv, behind);
        item.material.unlit = is_line;
        item.stage = stage;
        item.id = static_cast<std::uint32_t>(index) + 1;
        // A plane that is seen from behind has its other side culled, in the mirror too, where that may be the side that is seen.
        item.both_sides = behind;
        item.in_mirror =
            static_cast<int>(index) != mirror_ && !(behind && made_.frame.has_mirror && !is_behind(head_in_mirror_, g.position, g.axes[2]));
        item.casts_shadow = !is_line;
        item.in_planes = g.segid >= 0 || request_.pass == Pass::depth;
        for (const Part& part : parts_of(g, model_.numbers, scene_, is_mirror)) {
            item.mesh = part.mesh;
            item.mirrors = part.mirrors;
            if (!is_soft)
                item.world_from_object = matrix(to_double(g.axes[0]) * static_cast<double>(part.scale.x),
                                                to_double(g.axes[1]) * static_cast<double>(part.scale.y),
                                                to_double(g.axes[2]) * static_cast<double>(part.scale.z),
                                                to_double(g.position) + to_double(g.axes[2]) * static_cast<double>(part.shift));
            made_.frame.items.push_back(item);
        }
    }

    /// A cylinder around the head, and over it the haze of the first infinite plane.
    void add_sky() {
        FixedItem item;
        item.mesh = static_cast<int>(Shape::cylinder);
        // In a frame of depth alone it is a surface as others are.
        const bool in_planes = request_.pass == Pass::depth;
        item.stage = in_planes ? FixedStage::solid : FixedStage::backdrop;
        item.both_sides = true;
        item.in_planes = in_planes;
        item.in_mirror = item.casts_shadow = false;
        item.material.color = {1, 1, 1, 1};
        item.material.unlit = item.material.generated = true;
        item.material.texture = model_.sky;
        item.material.planes[0] = {1, 0, 0, 0}, item.material.planes[1] = {0, 0, 1, 0}, item.material.planes[2] = {0, -1, 0, 0};
        const float radius = made_.far_z * kSkyShare / room_.scale();
        const auto r = static_cast<double>(radius);
        item.world_from_object = matrix({r, 0, 0}, {0, r, 0}, {0, 0, r}, to_double(head_));
        made_.frame.items.push_back(item);
        const auto plane = std::find_if(made_.geoms.begin(), made_.geoms.end(),
                                        [](const Geom& g) { return g.type == kPlane && g.size.x == 0 && g.size.y == 0; });
        if (!flags_[kHaze] || plane == made_.geoms.end()) return;
        const float height = dot(head_ - plane->position, plane->axes[2]) / radius;
        if (height < 0) return;
        item.mesh = static_cast<int>(Shape::haze);
        if (!in_planes) item.stage = FixedStage::haze;
        item.material.texture = -1;
        item.material.generated = false;
        const Vec3d up = to_double(plane->axes[2]) * (r * static_cast<double>(height));
        item.world_from_object = matrix(to_double(plane->axes[0]) * r, to_double(plane->axes[1]) * r, up, to_double(head_) - up);
        made_.frame.items.push_back(item);
    }

    const FrameModel& model_;
    const Scene& scene_;
    const FrameRequest& request_;
    Room room_;
    bool flags_[kFlagCount] = {};
    Vec3f head_, gaze_, head_in_mirror_;  ///< in the model's space
    int mirror_ = -1;
    SceneFrame made_;
};

}  // namespace

Result<FrameModel> frame_model(const Model& model, const Look& look, const ModelMeshes& made) {
    FrameModel to{.layout = model.layout,
                  .look = look,
                  .shadow_clip = static_cast<float>(static_cast<double>(model.shadowclip) * model.extent),
                  .shadow_scale = model.shadowscale,
                  .fog_start = static_cast<float>(static_cast<double>(model.fogstart) * model.extent),
                  .fog_end = static_cast<float>(static_cast<double>(model.fogend) * model.extent),
                  .line_width = model.linewidth,
                  .fog_color = {model.fog_rgba[0], model.fog_rgba[1], model.fog_rgba[2]},
                  .shadow_size = model.shadowsize,
                  .numbers = {{}, made.planes, made.models, made.hfields, made.skins, made.flexes, made.end, made.soft},
                  .materials = {},
                  .cubes = {}};
    constexpr int kSkyTexture = 2;
    for (int i = 0; i < model.ntex; ++i) {
        to.cubes.push_back(model.tex_type[i] != 0);
        if (model.tex_type[i] == kSkyTexture && to.sky < 0) to.sky = i;
    }
    for (int i = 0; i < model.nmat && model.mat_texid != nullptr; ++i) {
        if (model.mat_texid[i] >= model.ntex)
            return fail(ErrorCode::bad_input, fmt::format("mat_texid: {} of {} textures", model.mat_texid[i], model.ntex));
        to.materials.push_back({std::max(-1, model.mat_texid[i]),
                                model.mat_texuniform != nullptr && model.mat_texuniform[i] != 0,
                                {model.mat_texrepeat[2 * i], model.mat_texrepeat[2 * i + 1]}});
    }
    return to;
}

Result<SceneFrame> make_frame(const FrameModel& model, const Scene& scene, const FrameRequest& request) {
    return FrameMaker(model, scene, request).make();
}

}  // namespace halflit::engine::mujoco
