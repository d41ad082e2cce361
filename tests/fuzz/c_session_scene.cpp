// Calls that fill a scene.
#include "tests/fuzz/c_session.hpp"

namespace halflit::fuzz {

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
    // As many numbers as the member has.
    const auto numbers = [&](const auto& member) {
        using Member = std::remove_cvref_t<decltype(member)>;
        if constexpr (std::is_array_v<Member>)
            return floats<std::extent_v<Member>>();
        else
            return in_.real();
    };
#define HALFLIT_NUMBER(member, ...) \
    if (in_.one_in(2)) material.set(&halflit_material::member, numbers(halflit_material{}.member));
#define HALFLIT_TEXTURE(slot, ...) \
    if (in_.one_in(4)) material.set(&halflit_material::slot##_texture, texture_use());
#include "shading/material_properties.def"
    material.set(&halflit_material::alpha_mode, choice(3));
    material.set(&halflit_material::double_sided, in_.flag());
    material.set(&halflit_material::unlit, in_.one_in(8));
    material.set(&halflit_material::lobe, halflit_lobe{in_.real(), in_.real(), in_.flag()});
    if (in_.one_in(4)) material.damage(in_, offsetof(halflit_material, alpha_mode));
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
    switch (in_.below(7)) {
        case 0: {
            const auto matrix = floats<16>();
            std::int32_t at = 0;
            if (in_.flag()) return check(halflit_scene_place_instance(scene(), index(), or_null(matrix.data(), 3)));
            if (in_.one_in(4)) {
                Sized<halflit_instance> instance(in_);
                check(halflit_instance_init(instance.get(), instance.size()));
                instance.damage(in_, offsetof(halflit_instance, mesh));
                instance.set(&halflit_instance::mesh, index());
                instance.set(&halflit_instance::material, in_.flag() ? -1 : index());
                return check(halflit_scene_set_instance(scene(), index(), or_null(instance.get())));
            }
            if (in_.one_in(4)) return check(halflit_scene_add_instances(scene(), index(), in_.one_in(8) ? index() : 1, matrix.data(), &at));
            return check(halflit_scene_add_instance(scene(), index(), or_null(matrix.data(), 2), or_null(&at, 3)));
        }
        case 2: {
            const std::int32_t at = index();
            if (in_.flag()) return check(halflit_scene_set_name(scene(), choice(6), at, or_null("part")));
            switch (in_.below(4)) {
                case 0:
                    return check(halflit_scene_remove_mesh(scene(), at));
                case 1:
                    return check(halflit_scene_remove_light(scene(), at));
                case 2:
                    return check(halflit_scene_remove_texture(scene(), at));
                default:
                    return check(halflit_scene_remove_instance(scene(), at));
            }
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
            mesh.set(&halflit_mesh::smooth, in_.one_in(3));
            Sized<halflit_splats> splats(in_);
            const std::size_t degree = in_.below(5);
            const Floats harmonics = floats(3 * (degree + 1) * (degree + 1) * vertices);
            if (in_.one_in(4)) {
                check(halflit_splats_init(splats.get(), splats.size()));
                for (auto member : {&halflit_splats::rotations, &halflit_splats::scales, &halflit_splats::opacities})
                    splats.set(member, or_null(others.data()));
                splats.set(&halflit_splats::harmonics, or_null(harmonics.data()));
                splats.set(&halflit_splats::degree, in_.one_in(12) ? -1 : static_cast<std::int32_t>(degree));
                splats.set(&halflit_splats::reference, static_cast<std::int32_t>(in_.below(5)));
                mesh.set(&halflit_mesh::topology, HALFLIT_TOPOLOGY_POINTS);
                mesh.set(&halflit_mesh::splats, splats.get());
            }
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
    } else if (in_.one_in(4)) {
        const double target[3] = {in_.real(), in_.real(), in_.real()};
        check(halflit_camera_orbit(or_null(target), in_.real() * 90.0, in_.real() * 45.0, in_.real(),
                                   static_cast<std::int32_t>(in_.below(8)), or_null(camera.get())));
    } else if (in_.one_in(4)) {
        Sized<halflit_view> view(in_);
        check(halflit_view_init(view.get(), view.size()));
        if (in_.flag()) check(halflit_view_by_name(scene(), or_null(in_.flag() ? "iso" : "side"), or_null(view.get())));
        if (in_.one_in(3)) view.damage(in_, offsetof(halflit_view, margin_x));
        if (in_.flag())
            check(halflit_camera_view(scene(), in_.real(), or_null(view.get()), or_null(camera.get())));
        else
            check(halflit_camera_views(scene(), in_.real(), or_null(view.get()), static_cast<std::int32_t>(in_.below(2)),
                                       or_null(camera.get())));
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
            return check(in_.one_in(2) ? halflit_scene_add_default_lights(scene(), or_null(view.get()))
                                       : halflit_scene_add_studio(scene(), or_null(view.get())));
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

}  // namespace halflit::fuzz
