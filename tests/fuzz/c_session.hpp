// Calls of the C interface, decoded from a fuzz input.
#pragma once

#include "tests/fuzz/c_structs.hpp"

#include <array>

namespace halflit::fuzz {

inline constexpr int kMaxCalls = 80;
inline constexpr std::size_t kMaxHandles = 3;

using Floats = std::vector<float>;

/// Calls of one input, and how many of the slow ones are left.
class Session {
public:
    explicit Session(View bytes) : in_(bytes) {}
    ~Session() {
        for (halflit_scene* scene : scenes_) halflit_scene_destroy(scene);
        for (halflit_renderer* renderer : renderers_) halflit_renderer_destroy(renderer);
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void run() {
        if (!in_.one_in(4)) begin();
        for (int i = 0; i < kMaxCalls && !in_.empty(); ++i) call();
    }

private:
    void begin();
    void call();
    void handles();
    void read_scene();
    void textures_and_materials();
    void meshes_and_instances();
    void cameras_and_lights();
    void environments();
    void draw();
    void pictures();

    /// A code of the header, with a message where it is not HALFLIT_OK. A fault of the library is never right.
    static void check(std::int32_t code) {
        HALFLIT_PROMISE(code >= 0 && code <= 7 && code != 1 && code != HALFLIT_ERROR_INTERNAL);
        HALFLIT_PROMISE(code == HALFLIT_OK || halflit_last_error()[0] != '\0');
    }
    /// A call whose arguments include a null pointer that the header does not allow.
    static void check_refused(std::int32_t code) { HALFLIT_PROMISE(code == HALFLIT_ERROR_USAGE && halflit_last_error()[0] != '\0'); }

    halflit_scene* scene() { return in_.one_in(40) ? nullptr : scenes_[in_.one_in(4) ? in_.below(kMaxHandles) : 0]; }
    halflit_renderer* renderer() { return in_.one_in(40) ? nullptr : renderers_[in_.one_in(4) ? in_.below(kMaxHandles) : 0]; }
    std::int32_t index() { return in_.one_in(12) ? in_.number<std::int32_t>() : static_cast<std::int32_t>(in_.below(4)); }
    std::int32_t choice(int count) {
        return in_.one_in(20) ? in_.number<std::int32_t>() : static_cast<std::int32_t>(in_.below(static_cast<std::size_t>(count)));
    }
    Floats floats(std::size_t count) {
        Floats values(count);
        for (float& value : values) value = in_.real();
        return values;
    }
    template <std::size_t Count>
    std::array<float, Count> floats() {
        std::array<float, Count> values;
        for (float& value : values) value = in_.real();
        return values;
    }
    /// The pointer, or sometimes null.
    template <class T>
    T* or_null(T* pointer, std::size_t seldom = 24) {
        return in_.one_in(seldom) ? nullptr : pointer;
    }

    halflit_texture_use texture_use();
    Sized<halflit_material> material();
    Sized<halflit_camera> camera();
    Sized<halflit_settings> settings();
    Sized<halflit_execution> execution();

    Input in_;
    std::array<halflit_scene*, kMaxHandles> scenes_{};
    std::array<halflit_renderer*, kMaxHandles> renderers_{};
    int frames_left_ = 5, environments_left_ = 1, demos_left_ = 1;
};

}  // namespace halflit::fuzz
