// Calls that light a scene by an environment, draw it and write pictures.
#include "tests/fuzz/c_session.hpp"

#include <memory>

namespace halflit::fuzz {

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
    settings.set(&halflit_settings::samples, in_.one_in(20) ? 3 : in_.one_in(8) ? 16 : in_.flag() ? 1 : 4);
    settings.set(&halflit_settings::shadow_size, 64);
    settings.set(&halflit_settings::shadows, choice(3));
    settings.set(&halflit_settings::tone_curve, choice(4));
    // Direct integration over an environment (reference) takes seconds for each lobe.
    settings.set(&halflit_settings::accuracy, environments_left_ > 0 ? choice(2) : 1);
    settings.set(&halflit_settings::shading_rate, in_.one_in(3) ? choice(3) : 2);
    settings.set(&halflit_settings::anisotropy, in_.one_in(20) ? 17 : in_.flag() ? 1 : 5);
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
    halflit_lighting* chosen = nullptr;
    if (in_.one_in(4)) {
        Sized<halflit_picture_request> request(in_);
        (void)halflit_picture_request_init(request.get(), request.size());
        request.damage(in_, offsetof(halflit_picture_request, studio_turn_rad));
        request.set(&halflit_picture_request::camera, static_cast<const halflit_camera*>(in_.flag() ? view.get() : nullptr));
        request.set(&halflit_picture_request::studio, choice(4));
        request.set(&halflit_picture_request::width, in_.one_in(8) ? index() : w);
        request.set(&halflit_picture_request::height, in_.one_in(8) ? index() : h);
        std::int32_t size[2];
        check(halflit_choose_picture(scene(), or_null(request.get(), 2), in_.flag() ? size : nullptr, or_null(view.get()),
                                     or_null(how.get()), in_.flag() ? &chosen : nullptr));
    }
    const std::unique_ptr<halflit_lighting, void (*)(halflit_lighting*)> lighting(chosen, halflit_lighting_destroy);
    how.set(&halflit_settings::shadow_size, 64);
    const std::int32_t format = in_.one_in(20) ? in_.number<std::int32_t>() : static_cast<std::int32_t>(in_.below(6));
    const std::size_t pixel = format >= HALFLIT_FORMAT_RGBA_F32 ? 16 : 4, row = pixel * (width + padding);
    std::vector<float> pixels((row * (height - 1) + pixel * width) / 4), depth(width * height), normal(3 * width * height);
    std::vector<std::uint32_t> instance(width * height), triangle(width * height), lights(width * height);
    std::vector<float> shading_normal(3 * width * height), albedo(3 * width * height), position(3 * width * height),
        coverage(width * height), barycentric(2 * width * height), uv(2 * width * height);
    check(halflit_target_init(target.get(), target.size()));
    target.set(&halflit_target::pixels, or_null(pixels.data()));
    target.set(&halflit_target::row_bytes, padding == 0 && in_.flag() ? 0 : row);
    if (in_.one_in(3)) {
        target.set(&halflit_target::depth, or_null(depth.data(), 3));
        target.set(&halflit_target::normal, or_null(normal.data(), 3));
        target.set(&halflit_target::instance, or_null(instance.data(), 3));
        target.set(&halflit_target::triangle, or_null(triangle.data(), 3));
        target.set(&halflit_target::shading_normal, shading_normal.data());
        target.set(&halflit_target::albedo, albedo.data());
        target.set(&halflit_target::position, position.data());
        target.set(&halflit_target::lights, lights.data());
        target.set(&halflit_target::coverage, coverage.data());
        target.set(&halflit_target::barycentric, barycentric.data());
        target.set(&halflit_target::uv, uv.data());
    }
    static constexpr std::int32_t kWrong[] = {0, -1, 32769, 2147483647};
    target.set(&halflit_target::width, in_.one_in(30) ? in_.pick(kWrong) : w);
    target.set(&halflit_target::height, in_.one_in(30) ? in_.pick(kWrong) : h);
    target.set(&halflit_target::format, format);
    target.set(&halflit_target::region_alone, in_.one_in(6));
    halflit_renderer* const by = renderer();
    const std::int32_t code = halflit_render(by, scene(), lighting.get(), or_null(view.get()), or_null(how.get(), 60),
                                             or_null(target.get()), or_null(report.get(), 3));
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

}  // namespace halflit::fuzz
