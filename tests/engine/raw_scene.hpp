// Scenes of MuJoCo in memory, as mjv_updateScene() leaves them.
#pragma once

#include "apps/engine/mujoco/model.hpp"
#include "halflit/math.hpp"

#include <cstring>
#include <vector>

namespace halflit::test {

/// Memory of geoms, lights and two cameras by a layout.
class RawScene {
public:
    explicit RawScene(const engine::mujoco::Layout& layout = {}) : layout_(layout) {
        const int wide = layout.camera_size;
        cameras_.resize(static_cast<std::size_t>(2 * wide));
        look_from({0, -4, 2}, {0, 1, -0.4f});
        for (int i = 0; i < 2; ++i) {
            put(cameras_, wide * i + layout.camera_bottom, -0.04f);
            put(cameras_, wide * i + layout.camera_top, 0.04f);
            put(cameras_, wide * i + layout.camera_near, 0.1f);
            put(cameras_, wide * i + layout.camera_far, 50.0f);
        }
    }
    void look_from(Vec3f position, Vec3f forward) {
        for (int i = 0; i < 2; ++i) {
            // The two eyes are apart, and the picture is seen from between them.
            put(cameras_, layout_.camera_size * i + layout_.camera_pos, position + Vec3f{i == 0 ? -0.03f : 0.03f, 0, 0});
            put(cameras_, layout_.camera_size * i + layout_.camera_forward, forward);
            put(cameras_, layout_.camera_size * i + layout_.camera_up, Vec3f{0, 0, 1});
        }
    }
    /// Adds a geom, upright; others of its members by set().
    int add(int type, Vec3f position, Vec3f size, Vec4f rgba = {0.5f, 0.5f, 0.5f, 1}) {
        const int index = count_++;
        geoms_.resize(static_cast<std::size_t>(count_ * layout_.geom_size));
        set(index, layout_.geom_type, type);
        set(index, layout_.geom_dataid, -1);
        set(index, layout_.geom_objtype, 5);
        set(index, layout_.geom_objid, 100 + index);
        if (layout_.geom_texid >= 0) set(index, layout_.geom_texid, -1);
        if (layout_.geom_matid >= 0) set(index, layout_.geom_matid, -1);
        set(index, layout_.geom_segid, index);
        set(index, layout_.geom_scale, size);
        set(index, layout_.geom_pos, position);
        constexpr float kUpright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        set(index, layout_.geom_mat, kUpright);
        set(index, layout_.geom_rgba, rgba);
        return index;
    }
    template <class T>
    void set(int geom, int place, const T& value) {
        put(geoms_, geom * layout_.geom_size + place, value);
    }
    int add_light(Vec3f position, Vec3f direction, bool casts_shadow) {
        const int index = lights_count_++;
        lights_.resize(static_cast<std::size_t>(lights_count_ * layout_.light_size));
        const int at = index * layout_.light_size;
        put(lights_, at + layout_.light_pos, position);
        put(lights_, at + layout_.light_dir, direction);
        put(lights_, at + layout_.light_attenuation, Vec3f{1, 0, 0});
        put(lights_, at + layout_.light_cutoff, 45.0f);
        put(lights_, at + layout_.light_ambient, Vec3f{0.2f, 0.2f, 0.2f});
        put(lights_, at + layout_.light_diffuse, Vec3f{0.6f, 0.6f, 0.6f});
        put(lights_, at + layout_.light_castshadow, static_cast<std::uint8_t>(casts_shadow));
        return index;
    }
    template <class T>
    void set_light(int light, int place, const T& value) {
        put(lights_, light * layout_.light_size + place, value);
    }
    /// Valid until something is added.
    [[nodiscard]] engine::mujoco::Scene scene() const {
        engine::mujoco::Scene made;
        made.geoms = geoms_.data(), made.ngeom = count_;
        made.lights = lights_.data(), made.nlight = lights_count_;
        made.camera = cameras_.data();
        return made;
    }

private:
    template <class T>
    static void put(std::vector<std::byte>& memory, int place, const T& value) {
        std::memcpy(memory.data() + place, &value, sizeof value);
    }

    engine::mujoco::Layout layout_;
    std::vector<std::byte> geoms_, lights_, cameras_;
    int count_ = 0, lights_count_ = 0;
};

}  // namespace halflit::test
