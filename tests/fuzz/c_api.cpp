// Sequences of calls of the C interface: handles made and freed in any order, wrong values, null pointers, structs of other sizes. What the
// header leaves to the caller, such as the length of an array, is always right.
#include "tests/fuzz/c_structs.hpp"

#include <array>
#include <string>

namespace halflit::fuzz {
namespace {

constexpr int kMaxCalls = 80;
constexpr std::size_t kMaxHandles = 3;

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
            halflit_scene* loaded = nullptr;
            const Bytes bytes(in_.rest().begin(), in_.rest().begin() + static_cast<std::ptrdiff_t>(in_.rest().size() / 2));
            check(halflit_scene_load_memory(or_null(bytes.data()), bytes.size(), or_null("fuzz"), nullptr, or_null(options.get(), 2),
                                            &loaded));
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
    std::int32_t mesh = 0;
    float matrix[16];
    check(halflit_scene_get_instance(scene(), index(), or_null(&mesh, 3), or_null(matrix, 3)));
}

halflit_texture_use Session::texture_use() {
    halflit_texture_use use{};
    use.texture = in_.one_in(3) ? index() : -1;
    use.uv_set = choice(2);
    for (std::int32_t* member : {&use.wrap_u, &use.wrap_v, &use.mip_filter}) *member = choice(3);
    for (std::int32_t* member : {&use.mag_filter, &use.min_filter}) *member = choice(2);
    use.row_u[0] = use.row_v[1] = 1;
    if (in_.one_in(6))
        for (float& value : use.row_u) value = in_.real();
    return use;
}

Sized<halflit_material> Session::material() {
    Sized<halflit_material> material(in_);
    const std::int32_t code = halflit_material_init(material.get(), material.size());
    check(code);
    material.set(&halflit_material::base_color, floats<4>());
    material.set(&halflit_material::metallic, in_.real());
    material.set(&halflit_material::roughness, in_.real());
    material.set(&halflit_material::alpha_mode, choice(3));
    material.set(&halflit_material::double_sided, in_.flag());
    material.set(&halflit_material::unlit, in_.one_in(8));
    material.set(&halflit_material::lobe, halflit_lobe{in_.real(), in_.real(), in_.flag()});
    if (in_.one_in(2))
        for (auto member : {&halflit_material::base_color_texture, &halflit_material::metallic_roughness_texture,
                            &halflit_material::normal_texture, &halflit_material::occlusion_texture, &halflit_material::emissive_texture})
            material.set(member, texture_use());
    if (in_.one_in(4)) material.damage(in_, offsetof(halflit_material, base_color));
    return material;
}

void Session::textures_and_materials() {
    switch (in_.below(4)) {
        case 0: {
            const std::size_t width = 1 + in_.below(6), height = 1 + in_.below(6), row = 4 * (width + in_.below(3));
            Bytes rgba((height - 1) * row + 4 * width);
            for (std::uint8_t& b : rgba) b = in_.byte();
            const std::size_t row_bytes = row == 4 * width && in_.flag() ? 0 : row;
            const auto w = static_cast<std::int32_t>(width), h = static_cast<std::int32_t>(height);
            std::int32_t at = 0;
            if (in_.flag()) return check(halflit_scene_set_texture(scene(), index(), or_null(rgba.data()), w, h, row_bytes, choice(2)));
            check_refused(halflit_scene_add_texture(scene(), rgba.data(), w, h, 4 * width - 1, 0, nullptr));
            check_refused(halflit_scene_add_texture(scene(), rgba.data(), in_.flag() ? 0 : 16385, h, 0, 0, nullptr));
            return check(halflit_scene_add_texture(scene(), or_null(rgba.data()), w, h, row_bytes, choice(2), or_null(&at, 3)));
        }
        case 1: {
            static constexpr const char* kNames[] = {"lambert", "green", "half-lambert", "valve", "sloan", "mcauley", "", "phong"};
            halflit_lobe lobe{};
            return check(halflit_lobe_by_name(or_null(in_.pick(kNames)), in_.real(), or_null(&lobe)));
        }
        default: {
            auto made = material();
            std::int32_t at = 0;
            if (in_.flag()) return check(halflit_scene_set_material(scene(), index(), or_null(made.get())));
            return check(halflit_scene_add_material(scene(), or_null(made.get()), or_null(&at, 3)));
        }
    }
}

void Session::meshes_and_instances() {
    const std::size_t vertices = in_.below(12);
    const Floats positions = floats(3 * vertices), others = floats(4 * vertices);
    std::vector<std::uint32_t> indices(in_.one_in(12) ? in_.below(10) : 3 * in_.below(6));
    for (std::uint32_t& i : indices) i = in_.one_in(30) ? in_.number<std::uint32_t>() : static_cast<std::uint32_t>(in_.below(vertices + 1));
    switch (in_.below(5)) {
        case 0: {
            const auto matrix = floats<16>();
            std::int32_t at = 0;
            if (in_.flag()) return check(halflit_scene_set_instance(scene(), index(), or_null(matrix.data(), 3)));
            return check(halflit_scene_add_instance(scene(), index(), or_null(matrix.data(), 2), or_null(&at, 3)));
        }
        case 1:
            return check(halflit_scene_set_vertices(scene(), index(), or_null(positions.data()), or_null(others.data(), 2), vertices));
        default: {
            Sized<halflit_mesh> mesh(in_);
            check(halflit_mesh_init(mesh.get(), mesh.size()));
            mesh.set(&halflit_mesh::positions, or_null(positions.data()));
            for (auto member :
                 {&halflit_mesh::normals, &halflit_mesh::tangents, &halflit_mesh::uv0, &halflit_mesh::uv1, &halflit_mesh::colors})
                mesh.set(member, or_null(others.data(), 2));
            mesh.set(&halflit_mesh::vertex_count, vertices);
            if (in_.flag()) {
                mesh.set(&halflit_mesh::indices, or_null(indices.data()));
                mesh.set(&halflit_mesh::index_count, indices.size());
            }
            mesh.set(&halflit_mesh::material, in_.flag() ? -1 : index());
            std::int32_t at = 0;
            if (in_.one_in(3)) return check(halflit_scene_set_mesh(scene(), index(), or_null(mesh.get())));
            return check(halflit_scene_add_mesh(scene(), or_null(mesh.get()), or_null(&at, 3)));
        }
    }
}

Sized<halflit_camera> Session::camera() {
    Sized<halflit_camera> camera(in_);
    check(halflit_camera_init(camera.get(), camera.size()));
    if (in_.one_in(3)) {
        const auto eye = floats<3>(), target = floats<3>(), up = floats<3>();
        check(halflit_camera_look_at(or_null(eye.data()), or_null(target.data()), or_null(up.data(), 2), or_null(camera.get())));
    } else {
        check(halflit_camera_frame(scene(), in_.real(), in_.real() * 45.0f, in_.real() * 20.0f, in_.real(), or_null(camera.get())));
    }
    if (in_.one_in(3)) camera.damage(in_, offsetof(halflit_camera, world_from_camera));
    return camera;
}

void Session::cameras_and_lights() {
    auto view = camera();
    Sized<halflit_light> light(in_);
    const auto sky = floats<3>(), ground = floats<3>();
    std::int32_t at = 0;
    switch (in_.below(6)) {
        case 0:
            return check(halflit_scene_set_ambient(scene(), or_null(sky.data()), or_null(ground.data())));
        case 1:
            return check(halflit_scene_add_default_lights(scene(), or_null(view.get())));
        case 2:
            return check(halflit_scene_clear_lights(scene()));
        default:
            check(halflit_light_init(light.get(), light.size()));
            light.set(&halflit_light::type, choice(3));
            light.set(&halflit_light::color, floats<3>());
            light.set(&halflit_light::position, floats<3>());
            light.set(&halflit_light::direction, floats<3>());
            if (in_.one_in(3)) light.damage(in_, offsetof(halflit_light, type));
            if (in_.one_in(4)) return check(halflit_scene_set_light(scene(), index(), or_null(light.get())));
            return check(halflit_scene_add_light(scene(), or_null(light.get()), or_null(&at, 3)));
    }
}

void Session::environments() {
    Sized<halflit_environment_options> options(in_);
    check(halflit_environment_options_init(options.get(), options.size()));
    options.damage(in_, offsetof(halflit_environment_options, rotate_rad));
    check_refused(halflit_scene_set_environment(scene(), nullptr, 2, 2, nullptr));
    check(halflit_scene_load_environment(scene(), or_null("/nonexistent/sky.hdr"), options.get()));
    if (environments_left_-- <= 0) return;
    const std::size_t width = 1 + in_.below(6), height = 1 + in_.below(4);
    const Floats rgb = floats(3 * width * height);
    check(halflit_scene_set_environment(scene(), rgb.data(), static_cast<std::int32_t>(width), static_cast<std::int32_t>(height),
                                        or_null(options.get(), 2)));
}

Sized<halflit_execution> Session::execution() {
    static constexpr const char* kIsas[] = {"scalar", "avx2", "sse9", ""};
    Sized<halflit_execution> how(in_);
    check(halflit_execution_init(how.get(), how.size()));
    how.set(&halflit_execution::threads, in_.one_in(12) ? -1 : 1);
    how.set(&halflit_execution::tile_size, in_.one_in(12) ? 0 : 16 << in_.below(3));
    if (in_.one_in(3)) how.set(&halflit_execution::isa, in_.pick(kIsas));
    how.set(&halflit_execution::user, this);
    if (in_.one_in(6)) {
        const auto cancelled = +[](void* user) -> std::int32_t { return static_cast<Session*>(user)->in_.one_in(8); };
        how.set(&halflit_execution::cancelled, cancelled);
    }
    if (in_.one_in(6)) {  // backwards, now and then not every part
        const auto loop = +[](void* user, std::int32_t count, void (*body)(void*, std::int32_t), void* task) {
            const bool all = !static_cast<Session*>(user)->in_.one_in(12);
            for (std::int32_t i = count; i-- > (all ? 0 : 1);) body(task, i);
        };
        how.set(&halflit_execution::parallel_for, loop);
    }
    return how;
}

Sized<halflit_settings> Session::settings() {
    Sized<halflit_settings> settings(in_);
    check(halflit_settings_init(settings.get(), settings.size()));
    settings.set(&halflit_settings::samples, in_.one_in(20) ? 3 : in_.flag() ? 1 : 4);
    settings.set(&halflit_settings::shadow_size, 64);
    settings.set(&halflit_settings::shadows, choice(3));
    // Direct integration over an environment (reference) takes seconds for each lobe.
    settings.set(&halflit_settings::accuracy, environments_left_ > 0 ? choice(4) : 1 + choice(3));
    settings.set(&halflit_settings::shading_rate, in_.one_in(3) ? choice(3) : 2);
    settings.set(&halflit_settings::texture_detail, in_.one_in(3) ? choice(3) : 0);
    settings.set(&halflit_settings::background_environment, in_.one_in(6));
    if (in_.one_in(4)) settings.set(&halflit_settings::region, halflit_region{index(), index(), index(), index()});
    if (in_.one_in(6)) settings.set(&halflit_settings::max_error_codes, static_cast<double>(in_.real()));
    if (in_.one_in(4)) settings.damage(in_, offsetof(halflit_settings, region));
    return settings;
}

void Session::draw() {
    if (frames_left_-- <= 0) return;
    auto view = camera();
    auto how = settings();
    Sized<halflit_target> target(in_);
    Sized<halflit_report> report(in_);
    const std::size_t width = 1 + in_.below(24), height = 1 + in_.below(24), padding = in_.below(3);
    const auto w = static_cast<std::int32_t>(width), h = static_cast<std::int32_t>(height);
    if (in_.one_in(8)) check(halflit_auto_setup(scene(), w, h, or_null(view.get()), or_null(how.get())));
    how.set(&halflit_settings::shadow_size, 64);
    const std::int32_t format = in_.one_in(20) ? in_.number<std::int32_t>() : static_cast<std::int32_t>(in_.below(6));
    const std::size_t pixel = format >= HALFLIT_FORMAT_RGBA_F32 ? 16 : 4, row = pixel * (width + padding);
    std::vector<float> pixels((row * (height - 1) + pixel * width) / 4), depth(width * height), normal(3 * width * height);
    std::vector<std::uint32_t> instance(width * height), triangle(width * height);
    check(halflit_target_init(target.get(), target.size()));
    target.set(&halflit_target::pixels, or_null(pixels.data()));
    target.set(&halflit_target::row_bytes, padding == 0 && in_.flag() ? 0 : row);
    if (in_.one_in(3)) {
        target.set(&halflit_target::depth, or_null(depth.data(), 3));
        target.set(&halflit_target::normal, or_null(normal.data(), 3));
        target.set(&halflit_target::instance, or_null(instance.data(), 3));
        target.set(&halflit_target::triangle, or_null(triangle.data(), 3));
    }
    static constexpr std::int32_t kWrong[] = {0, -1, 32769, 2147483647};
    target.set(&halflit_target::width, in_.one_in(30) ? in_.pick(kWrong) : w);
    target.set(&halflit_target::height, in_.one_in(30) ? in_.pick(kWrong) : h);
    target.set(&halflit_target::format, format);
    target.set(&halflit_target::region_alone, in_.one_in(6));
    halflit_renderer* const by = renderer();
    const std::int32_t code =
        halflit_render(by, scene(), or_null(view.get()), or_null(how.get(), 60), or_null(target.get()), or_null(report.get(), 3));
    check(code);
    const char* text = nullptr;
    if (by != nullptr && halflit_renderer_get_warning(by, index(), &text) == HALFLIT_OK)
        HALFLIT_PROMISE(text != nullptr && text[0] != '\0');
    if (code == HALFLIT_OK) (void)halflit_pixel_hash(pixels.data(), pixels.size() * 4);
}

void Session::pictures() {
    static constexpr const char* kPaths[] = {"/nonexistent/x.png", "/nonexistent/x.hdr", "/nonexistent/x.jpg", "x.unknown", ""};
    Sized<halflit_target> target(in_);
    const auto memory = floats(4 * 4 * 4);
    check(halflit_target_init(target.get(), target.size()));
    target.set(&halflit_target::pixels, or_null(const_cast<float*>(memory.data())));
    target.set(&halflit_target::width, in_.one_in(8) ? -1 : 4);
    target.set(&halflit_target::height, in_.one_in(8) ? 0 : 4);
    target.set(&halflit_target::format, choice(6));
    const std::int32_t code = halflit_write_image(or_null(in_.pick(kPaths)), or_null(target.get()));
    HALFLIT_PROMISE(code != HALFLIT_OK);
    check(code);
    HALFLIT_PROMISE(halflit_version()[0] != '\0' && halflit_pixel_epoch() > 0 &&
                    halflit_pixel_hash(nullptr, 0) == halflit_pixel_hash("", 0));
}

void run(View input) { Session(input).run(); }

}  // namespace

const FuzzTarget kCApi{"c_api", 4096, run, nullptr};

}  // namespace halflit::fuzz
