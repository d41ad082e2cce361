// Scenes of MuJoCo become frames by the rules of its classic renderer, and nothing that a scene says is trusted.
#include "apps/engine/mujoco/frame.hpp"
#include "apps/engine/mujoco/geom_parts.hpp"
#include "tests/engine/raw_scene.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::engine::mujoco;
using halflit::test::RawScene;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A model of nothing but primitives.
FrameModel bare(const Layout& layout = {}) {
    Model model;
    model.layout = layout;
    const auto meshes = make_meshes(model);
    REQUIRE(meshes);
    auto made = frame_model(model, *look_of("2.2.2"), *meshes);
    REQUIRE(made);
    return *made;
}

FrameRequest request(const Scene& scene) { return {.camera = scene.camera, .flags = nullptr, .width = 64, .height = 48}; }

SceneFrame frame_of(const RawScene& raw, const FrameModel& model = bare()) {
    const Scene scene = raw.scene();
    auto made = make_frame(model, scene, request(scene));
    if (!made) FAIL(made.error().message);
    return std::move(*made);
}

std::string error_of(const RawScene& raw, const FrameModel& model = bare()) {
    const Scene scene = raw.scene();
    const auto made = make_frame(model, scene, request(scene));
    return made ? "" : made.error().message;
}

std::vector<std::uint32_t> ids(const SceneFrame& made, FixedStage stage) {
    std::vector<std::uint32_t> found;
    for (const FixedItem& item : made.frame.items)
        if (item.stage == stage) found.push_back(item.id);
    return found;
}

}  // namespace

TEST_CASE("mujoco frame: transparent geoms come from front to back, and planes last", "[engine][mujoco]") {
    const Layout at;
    RawScene raw;
    raw.add(kPlane, {0, 0, -1}, {1, 1, 1}, {1, 1, 1, 0.5f});
    raw.add(kSphere, {0, 3, 0}, {1, 1, 1}, {1, 1, 1, 0.99f});
    raw.add(kSphere, {0, 1, 0}, {1, 1, 1});
    raw.add(kSphere, {0, 2, 0}, {1, 1, 1}, {1, 1, 1, 0.2f});
    const int wide = raw.add(kSphere, {0, 4, 0}, {1, 1, 1}, {1, 1, 1, 0.2f});
    raw.set(wide, at.geom_modelrbound, 3.0f);  // its surface is nearer
    const SceneFrame made = frame_of(raw);
    CHECK(ids(made, FixedStage::solid) == std::vector<std::uint32_t>{3});
    CHECK(ids(made, FixedStage::transparent) == std::vector<std::uint32_t>{5, 4, 2, 1});
}

TEST_CASE("mujoco frame: a distance that is no number comes among the planes", "[engine][mujoco]") {
    const Layout at;
    RawScene raw;
    raw.set(raw.add(kBox, {0, 3e38f, 3e38f}, {3e38f, 3e38f, 3e38f}, {1, 1, 1, 0.5f}), at.geom_objtype, 0);  // infinity - infinity
    raw.add(kSphere, {0, 2, 0}, {1, 1, 1}, {1, 1, 1, 0.5f});
    raw.add(kSphere, {0, 1, 0}, {1, 1, 1}, {1, 1, 1, 0.5f});
    CHECK(ids(frame_of(raw), FixedStage::transparent) == std::vector<std::uint32_t>{3, 2, 1});
}

TEST_CASE("mujoco frame: the sky and its haze come after opaque geoms and before transparent ones", "[engine][mujoco]") {
    const Layout at;
    RawScene raw;
    raw.add(kSphere, {0, 1, 0}, {1, 1, 1}, {1, 1, 1, 0.5f});
    raw.set(raw.add(kPlane, {0, 0, -1}, {0, 0, 1}), at.geom_dataid, -1);
    FrameModel model = bare();
    model.sky = 0, model.cubes = {true};
    std::vector<FixedStage> stages;
    for (const FixedItem& item : frame_of(raw, model).frame.items) stages.push_back(item.stage);
    CHECK(stages == std::vector{FixedStage::solid, FixedStage::backdrop, FixedStage::haze, FixedStage::transparent});
    raw.look_from({0, -4, -2}, {0, 1, 0});  // below the plane
    CHECK(ids(frame_of(raw, model), FixedStage::haze).empty());
}

TEST_CASE("mujoco frame: a plane from behind is a pale one whose other side is culled", "[engine][mujoco]") {
    RawScene raw;
    raw.add(kPlane, {0, 0, 5}, {1, 1, 1}, {1, 1, 1, 0.9f});
    const SceneFrame made = frame_of(raw);
    REQUIRE(made.frame.items.size() == 1);
    CHECK(made.frame.items[0].stage == FixedStage::transparent);
    CHECK(made.frame.items[0].both_sides);
    CHECK(made.frame.items[0].material.color.w == Approx(0.27).epsilon(1e-6));
}

TEST_CASE("mujoco frame: the first opaque plane or box with reflectance mirrors, of a box its upper side", "[engine][mujoco]") {
    const Layout at;
    RawScene raw;
    for (const int type : {kSphere, kBox, kPlane}) raw.set(raw.add(type, {0, 1, -0.5f}, {1, 2, 0.25f}), at.geom_reflectance, 0.5f);
    const SceneFrame made = frame_of(raw);
    REQUIRE(made.frame.has_mirror);
    CHECK(made.frame.mirror.reflectance == 0.5f);
    CHECK(made.frame.mirror.point_ws == Vec3f{0, 1, -0.25f});
    CHECK(made.frame.mirror.normal_ws == Vec3f{0, 0, 1});
    // MuJoCo draws the mirror first, and of equal depths the last geom is seen, so here the mirror is the last. It has two parts, and is
    // not seen in itself.
    CHECK(ids(made, FixedStage::solid) == std::vector<std::uint32_t>{3, 1, 2, 2});
    CHECK(made.frame.items[2].mirrors);
    CHECK(!made.frame.items[3].mirrors);
    for (std::size_t i = 0; i < 4; ++i) CHECK(made.frame.items[i].in_mirror == (i < 2));
    RawScene below = raw;
    below.look_from({0, -4, -2}, {0, 1, 0});
    CHECK(!frame_of(below).frame.has_mirror);
}

TEST_CASE("mujoco frame: capsules and arrows reach as far as their sizes say", "[engine][mujoco]") {
    struct Row {
        int type;
        float low, high, wide;
    };
    for (const Row row : {Row{kCapsule, -3.5f, 3.5f, 0.5f}, Row{kCylinder, -3, 3, 0.5f}, Row{kArrow, 0, 1.5f, 0.875f},
                          Row{kArrow1, 0, 1.5f, 0.5f}, Row{kArrow2, -1.5f, 1.5f, 0.875f}, Row{kLine, 0, 3, 0}}) {
        INFO("type " << row.type);
        RawScene raw;
        raw.add(row.type, {0, 0, 0}, {0.5f, 0.5f, 3});
        Model model;
        const auto meshes = make_meshes(model);
        Bounds bounds;
        for (const FixedItem& item : frame_of(raw).frame.items) {
            CHECK(item.casts_shadow == (row.type != kLine));
            for (const Vec3f p : meshes->meshes[static_cast<std::size_t>(item.mesh)].positions) {
                const Vec4f q = item.world_from_object * Vec4f{p.x, p.y, p.z, 1};
                bounds.add({q.x, q.y, q.z});
            }
        }
        CHECK(bounds.min.z == Approx(row.low).margin(1e-5));
        CHECK(bounds.max.z == Approx(row.high).margin(1e-5));
        CHECK(bounds.max.x == Approx(row.wide).margin(1e-5));
    }
}

TEST_CASE("mujoco frame: from 3.12 on flat textures lie on shapes by their own coordinates", "[engine][mujoco]") {
    const std::vector<bool> cubes{false, true};
    Geom g{};
    g.use = {0, false, {3, 2}};
    g.size = {2, 4, 1};
    g.type = kBox;
    CHECK(material_of(g, cubes, false, false).generated);
    FixedMaterial box = material_of(g, cubes, true, false);
    CHECK(!box.generated);
    CHECK(box.texture == 0);
    CHECK(box.uv_scale == Vec2f{3, 2});
    g.use.uniform = true;
    CHECK(material_of(g, cubes, true, false).uv_scale == Vec2f{6, 8});
    g.use = {1, false, {3, 2}};
    CHECK(material_of(g, cubes, true, false).generated);  // a cube
    g.use = {0, false, {0, 2}};
    CHECK(material_of(g, cubes, true, false).uv_scale == Vec2f{1, 2});
    g.type = kHField;
    CHECK(material_of(g, cubes, true, false).generated);
    g.type = kMesh, g.texcoord = 1, g.use = {0, false, {3, 2}};
    CHECK(material_of(g, cubes, false, false).uv_scale == Vec2f{1, 1});
    CHECK(material_of(g, cubes, true, false).uv_scale == Vec2f{3, 2});

    // Planes: from 0 to the repetition over their size, v downwards; without a size the origin is at the repetition's middle.
    g.type = kPlane, g.texcoord = 0;
    const auto at = [&](float x, float y) {
        const FixedMaterial m = material_of(g, cubes, true, false);
        return Vec2f{m.planes[0].x * x + m.planes[0].w, m.planes[1].y * y + m.planes[1].w};
    };
    g.dataid = -1;
    CHECK(at(-1, 1) == Vec2f{0, 0});
    CHECK(at(1, -1) == Vec2f{3, 2});
    g.dataid = 0;
    CHECK(at(-2, 4) == Vec2f{0, 0});
    CHECK(at(2, -4) == Vec2f{3, 2});
    g.size = {0, 0, 1};
    CHECK(at(0, 0) == Vec2f{-0.5f, -0.5f});
    CHECK(at(2, -2) == Vec2f{2.5f, 1.5f});
}

TEST_CASE("mujoco frame: lights are OpenGL's", "[engine][mujoco]") {
    const Layout at;
    RawScene raw;
    CHECK(frame_of(raw).frame.ambient == 0.3f);
    raw.add_light({9, 9, 9}, {1, 0, 0}, false);
    raw.set_light(0, at.light_headlight, std::uint8_t{1});
    raw.set_light(0, at.light_directional, std::uint8_t{1});
    raw.add_light({0, 0, 3}, {0, 0, -1}, true);
    raw.add_light({0, 0, 3}, {0, 0, -1}, true);
    raw.set_light(2, at.light_cutoff, 120.0f);
    for (int i = 3; i < 10; ++i) raw.add_light({0, 0, 3}, {0, 0, -1}, true);
    const SceneFrame made = frame_of(raw);
    CHECK(made.frame.ambient == 0);
    REQUIRE(made.frame.lights.size() == 8);
    CHECK(made.frame.lights[0].directional);
    CHECK(made.frame.lights[0].shadow_size == 0);
    CHECK(made.frame.lights[0].position_ws == made.frame.camera.position_ws);
    CHECK(made.frame.lights[0].direction_ws == made.frame.camera.forward_ws);
    CHECK(made.frame.lights[1].shadow_size == 4096);
    CHECK(made.frame.lights[1].shadow_fov_deg == Approx(54));
    CHECK(made.frame.lights[1].cutoff_deg == 45);
    CHECK(made.frame.lights[2].cutoff_deg == 180);  // refused by OpenGL
    CHECK(made.frame.lights[2].shadow_fov_deg == Approx(144));
}

TEST_CASE("mujoco frame: a scene that is turned, scaled and moved with its camera gives the same view", "[engine][mujoco]") {
    RawScene raw;
    raw.add(kSphere, {0, 1, 0}, {1, 1, 1});
    raw.add_light({0, 0, 3}, {0, 0, -1}, true);
    raw.set_light(0, Layout().light_attenuation, Vec3f{1, 0.25f, 0});
    Scene scene = raw.scene();
    scene.enabletransform = true;
    scene.scale = 2;
    scene.translate[0] = 5;
    scene.rotate[0] = 0, scene.rotate[3] = 1;  // half a turn about z
    const auto made = make_frame(bare(), scene, request(scene));
    REQUIRE(made);
    // The camera at (0, -4, 2) is brought into the model instead, and lengths of its frustum with it.
    CHECK(made->frame.items[0].world_from_object.c[3] == Vec4f{0, 1, 0, 1});
    CHECK(made->frame.camera.position_ws == Vec3f{2.5f, 2, 1});
    CHECK(made->frame.camera.forward_ws.y == Approx(-1 / std::sqrt(1.16)));
    CHECK(made->frame.camera.far_z == 25);
    CHECK(made->frame.lights[0].position_ws == Vec3f{0, 0, 3});
    CHECK(made->frame.lights[0].attenuation[1] == 0.5f);
    CHECK(made->frame.lights[0].shadow_far == 50);
    // A rotation that is no unit quaternion stretches, which MuJoCo does not count where the head is.
    scene.rotate[3] = 2;
    const auto stretched = make_frame(bare(), scene, request(scene));
    REQUIRE(stretched);
    CHECK(stretched->frame.camera.position_ws == Vec3f{0.625f, 0.5f, 0.25f});
    CHECK(stretched->frame.camera.far_z == 6.25f);
    scene.rotate[3] = 0;
    CHECK(!make_frame(bare(), scene, request(scene)));
    scene.rotate[3] = 1, scene.scale = 0;
    CHECK(!make_frame(bare(), scene, request(scene)));
}

TEST_CASE("mujoco frame: members are where the layout says", "[engine][mujoco]") {
    Layout other;  // every member elsewhere, as in another version
    other.geom_size += 64, other.light_size += 64, other.camera_size += 64;
#define WHOLE(name, bytes)
#define MEMBER(type, name, count, whole, place, is_needed) other.name = place < 0 ? place : (place + 36);
#include "apps/engine/mujoco/layout_members.def"
    other.geom_texid = other.geom_texuniform = other.geom_texrepeat = -1;
    REQUIRE(check_layout(other));
    const auto build = [](const Layout& layout) {
        RawScene raw(layout);
        raw.set(raw.add(kBox, {0.5f, 1, 0}, {1, 2, 3}, {0.1f, 0.2f, 0.3f, 1}), layout.geom_specular, 0.75f);
        raw.add(kCapsule, {0.5f, 1, 2}, {1, 1, 3}, {0.1f, 0.2f, 0.3f, 0.5f});
        raw.add_light({1, 2, 3}, {0, 0.5f, -1}, true);
        return raw;
    };
    const SceneFrame a = frame_of(build({})), b = frame_of(build(other), bare(other));
    REQUIRE(a.frame.items.size() == 4);
    REQUIRE(b.frame.items.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(a.frame.items[i].mesh == b.frame.items[i].mesh);
        CHECK(a.frame.items[i].world_from_object == b.frame.items[i].world_from_object);
        CHECK(a.frame.items[i].material.color == b.frame.items[i].material.color);
        CHECK(a.frame.items[i].material.specular == b.frame.items[i].material.specular);
    }
    CHECK(a.frame.lights[0].position_ws == b.frame.lights[0].position_ws);
    CHECK(a.frame.camera.right == b.frame.camera.right);
    for (const std::int32_t wrong : {-2, 248 - 3, 1 << 30}) {
        Layout broken;
        broken.geom_type = wrong;
        CHECK(!check_layout(broken));
    }
}

TEST_CASE("mujoco frame: what a scene must not say is one line of error", "[engine][mujoco]") {
    const Layout at;
    const struct {
        int type, place;
        std::int32_t value;
        const char* words;
    } rows[] = {{kPlane, at.geom_dataid, 0, "geom 0: dataid is 0, the model has 0"},
                {kMesh, at.geom_dataid, 7, "geom 0: dataid is 7, the model has 0"},
                {kHField, at.geom_dataid, 1 << 30, "geom 0: dataid is"},
                {104, at.geom_objid, 3, "geom 0: objid is 3, the model has 0"},
                {kBox, at.geom_texid, 2, "geom 0: texid is 2, the model has 0"}};
    for (const auto& row : rows) {
        RawScene raw;
        raw.set(raw.add(row.type, {0, 0, 0}, {1, 1, 1}), row.place, row.value);
        CHECK(error_of(raw).find(row.words) == 0);
        CHECK(error_of(raw).find('\n') == std::string::npos);
    }
    for (const int place :
         {at.geom_pos, at.geom_mat, at.geom_scale, at.geom_rgba, at.geom_emission, at.geom_reflectance, at.geom_modelrbound})
        for (const float value : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
            RawScene raw;
            raw.set(raw.add(kBox, {0, 0, 0}, {1, 1, 1}), place, value);
            CHECK(error_of(raw) == "geom 0: a number is not finite");
        }
    // Numbers of types that nothing is drawn for, and of meshes that a geom does without.
    for (const std::int32_t type : {-5, -2, -1, 9, 105, 999, 1000, 1001, 1003, 1 << 30}) {
        RawScene raw;
        raw.add(type, {0, 0, 0}, {1, 1, 1});
        CHECK(frame_of(raw).frame.items.empty());
    }
    for (const float value : {kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        RawScene raw;
        raw.look_from({0, 0, 0}, {value, 0, 0});
        CHECK(error_of(raw).find("camera: ") == 0);
    }
}
