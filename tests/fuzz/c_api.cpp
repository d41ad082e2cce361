// Sequences of calls of the C interface: handles made and freed in any order, wrong values, null pointers, structs of other sizes. What the
// header leaves to the caller, such as the length of an array, is always right.
#include "tests/fuzz/c_session.hpp"

namespace halflit::fuzz {

/// A renderer, and a scene with two triangles, for the calls that come.
void Session::begin() {
    static constexpr float kCorners[] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0.5f}, kUv[] = {0, 1, 1, 1, 0, 0, 1, 0};
    static constexpr std::uint32_t kIndices[] = {0, 1, 2, 2, 1, 3};
    HALFLIT_PROMISE(halflit_renderer_create(nullptr, &renderers_[0]) == HALFLIT_OK);
    HALFLIT_PROMISE(halflit_scene_create(&scenes_[0]) == HALFLIT_OK);
    halflit_material material;
    HALFLIT_PROMISE(halflit_material_init(&material, sizeof material) == HALFLIT_OK);
    HALFLIT_PROMISE(halflit_scene_add_material(scenes_[0], &material, nullptr) == HALFLIT_OK);
    halflit_mesh mesh;
    HALFLIT_PROMISE(halflit_mesh_init(&mesh, sizeof mesh) == HALFLIT_OK);
    mesh.positions = kCorners;
    mesh.vertex_count = 4;
    mesh.uv0 = kUv;
    mesh.indices = kIndices;
    mesh.index_count = 6;
    mesh.material = 0;
    HALFLIT_PROMISE(halflit_scene_add_mesh(scenes_[0], &mesh, nullptr) == HALFLIT_OK);
    HALFLIT_PROMISE(halflit_scene_add_instance(scenes_[0], 0, nullptr, nullptr) == HALFLIT_OK);
    halflit_execution one_thread;
    HALFLIT_PROMISE(halflit_execution_init(&one_thread, sizeof one_thread) == HALFLIT_OK);
    one_thread.threads = 1;
    HALFLIT_PROMISE(halflit_renderer_set_execution(renderers_[0], &one_thread) == HALFLIT_OK);
}

void Session::call() {
    switch (in_.below(12)) {
        case 0:
        case 1:
            return handles();
        case 2:
            return read_scene();
        case 3:
        case 4:
            return textures_and_materials();
        case 5:
        case 6:
            return meshes_and_instances();
        case 7:
        case 8:
            return cameras_and_lights();
        case 9:
            return in_.one_in(4) ? environments() : read_scene();
        case 10:
            return pictures();
        default:
            return draw();
    }
}

void Session::handles() {
    auto& scene = scenes_[in_.below(kMaxHandles)];
    auto& renderer = renderers_[in_.below(kMaxHandles)];
    switch (in_.below(8)) {
        case 0:
            halflit_scene_destroy(scene);
            scene = nullptr;
            return;
        case 1:
            halflit_renderer_destroy(renderer);
            renderer = nullptr;
            return;
        case 2: {
            auto how = execution();
            return check(halflit_renderer_set_execution(renderer, or_null(how.get(), 8)));
        }
        case 3: {
            if (renderer != nullptr) return;
            auto how = execution();
            return check(halflit_renderer_create(or_null(how.get(), 8), &renderer));
        }
        case 4: {
            Sized<halflit_load_options> options(in_);
            (void)halflit_load_options_init(options.get(), options.size());
            options.damage(in_, offsetof(halflit_load_options, max_file_bytes));
            static constexpr const char* kNames[] = {nullptr, "", "0", "none", "wave", "1"};
            options.set(&halflit_load_options::animation, in_.pick(kNames));
            options.set(&halflit_load_options::scene, in_.pick(kNames));
            options.set(&halflit_load_options::variant, in_.pick(kNames));
            halflit_scene* loaded = nullptr;
            const Bytes bytes(in_.rest().begin(), in_.rest().begin() + static_cast<std::ptrdiff_t>(in_.rest().size() / 2));
            check(halflit_scene_load_memory(or_null(bytes.data()), bytes.size(), or_null("fuzz"), nullptr, or_null(options.get(), 2),
                                            &loaded));
            Sized<halflit_animation> animation(in_);
            check(halflit_scene_get_animation(loaded, index(), or_null(animation.get())));
            check(halflit_scene_pose(loaded, in_.pick(kNames), static_cast<double>(in_.real())));
            halflit_scene_destroy(loaded);
            return;
        }
        case 5: {
            check_refused(halflit_scene_create(nullptr));
            check_refused(halflit_scene_load_memory(nullptr, 4, "fuzz", nullptr, nullptr, nullptr));
            check_refused(halflit_renderer_create(nullptr, nullptr));
            halflit_scene* loaded = nullptr;
            const std::int32_t code = halflit_scene_load(or_null("/nonexistent/model.glb"), nullptr, &loaded);
            HALFLIT_PROMISE(code != HALFLIT_OK && loaded == nullptr);
            return check(code);
        }
        case 6:
            if (scene == nullptr && in_.one_in(32) && demos_left_-- > 0) return check(halflit_scene_create_demo(&scene));
            return;
        default:
            if (scene == nullptr) return check(halflit_scene_create(&scene));
    }
}

void Session::read_scene() {
    const char* text = nullptr;
    Sized<halflit_counts> counts(in_);
    check(halflit_scene_get_counts(scene(), or_null(counts.get())));
    if (halflit_scene_get_warning(scene(), index(), &text) == HALFLIT_OK) HALFLIT_PROMISE(text != nullptr);
    float min[3], max[3];
    check(halflit_scene_get_bounds(scene(), or_null(min), or_null(max)));
    Sized<halflit_material> material(in_);
    check(halflit_scene_get_material(scene(), index(), or_null(material.get())));
    Sized<halflit_light> light(in_);
    check(halflit_scene_get_light(scene(), index(), or_null(light.get())));
    Sized<halflit_camera> camera(in_);
    check(halflit_scene_get_camera(scene(), index(), or_null(camera.get())));
    Sized<halflit_instance> instance(in_);
    check(halflit_scene_get_instance(scene(), index(), or_null(instance.get())));
    Sized<halflit_node> node(in_);
    check(halflit_scene_get_node(scene(), index(), or_null(node.get())));
    if (halflit_scene_get_name(scene(), choice(6), index(), &text) == HALFLIT_OK) HALFLIT_PROMISE(text != nullptr);
}

namespace {

void run(View input) { Session(input).run(); }

}  // namespace

const FuzzTarget kCApi{"c_api", 4096, run, nullptr};

}  // namespace halflit::fuzz
