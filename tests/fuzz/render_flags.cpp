#include "tests/fuzz/render_flags.hpp"

#include "raster/settings_table.hpp"
#include "shading/material_properties.hpp"

#include <algorithm>
#include <array>

namespace halflit::fuzz {
namespace {

template <class Enum>
Enum one_of(Input& input, int count) {
    return static_cast<Enum>(input.below(static_cast<std::size_t>(count)));
}

Lobe read_lobe(Input& input) {
    const float wrap = static_cast<float>(input.byte()) / 255.0f;
    switch (input.below(6)) {
        case 0:
            return Lobe::lambert();
        case 1:
            return Lobe::green(wrap);
        case 2:
            return Lobe::valve();
        case 3:
            return Lobe::sloan(wrap);
        case 4:
            return Lobe::mcauley(wrap, static_cast<float>(input.byte()) / 16.0f);
        default:
            return {input.real(), input.real(), input.flag()};
    }
}

/// Values of all settings: mostly those of its range, some of them beside it.
void read_setting_values(Input& input, Settings& settings) {
    for (const raster::Setting& setting : raster::kSettings) {
        if (!input.one_in(3)) continue;
        const raster::SettingValues& values = setting.values;
        if (input.one_in(64)) {
            setting.set(settings, static_cast<double>(input.real()));
        } else if (!values.list.empty()) {
            setting.set(settings, static_cast<double>(values.list[input.below(values.list.size())]));
        } else if (values.kind == raster::SettingValues::Kind::number) {
            setting.set(settings, values.low + (std::min(values.high, 8.0) - values.low) * static_cast<double>(input.byte()) / 255.0);
        } else {
            // Whole numbers near the least, which cost least: of names all.
            const auto step = static_cast<double>(input.below(4));
            const double value = values.low + step * std::max(1, values.step);
            setting.set(settings, std::min(value, values.high));
        }
    }
}

Region read_region(Input& input, const RenderFlags& flags) {
    if (!input.one_in(3)) return {};
    Region region;
    region.x = static_cast<int>(input.below(static_cast<std::size_t>(flags.width)));
    region.y = static_cast<int>(input.below(static_cast<std::size_t>(flags.height)));
    region.width = 1 + static_cast<int>(input.below(static_cast<std::size_t>(flags.width - region.x)));
    region.height = 1 + static_cast<int>(input.below(static_cast<std::size_t>(flags.height - region.y)));
    if (input.one_in(32)) region.width = input.number<int>();
    return region;
}

Camera read_camera(Input& input) {
    Camera camera;
    const Vec3f eye{input.real(), input.real(), input.real()}, target{input.real(), input.real(), input.real()};
    camera.world_from_camera = look_at(eye, target, {0, 1, 0});
    camera.orthographic = input.one_in(3);
    if (input.one_in(2)) camera.fov_y_rad = input.real();
    if (input.one_in(4)) camera.aspect = input.real();
    if (camera.orthographic) camera.far_z = 100.0f;
    if (input.one_in(3)) camera.half_height = input.real();
    if (input.one_in(3)) camera.near_z = input.real();
    if (input.one_in(4)) camera.far_z = input.real();
    return camera;
}

Settings read_settings(Input& input, const RenderFlags& flags) {
    Settings settings;
    settings.region = read_region(input, flags);
    read_setting_values(input, settings);
    if (input.one_in(3)) settings.shading.lobe = read_lobe(input);
    settings.background_linear = {input.real(), input.real(), input.real(), input.flag() ? 1.0f : input.real()};
    settings.background_environment = flags.environment && input.flag();
    return settings;
}

TextureUse read_texture_use(Input& input, std::size_t textures) {
    TextureUse use;
    if (!input.one_in(3)) return use;
    use.texture = static_cast<int>(input.below(textures));
    use.uv_set = static_cast<int>(input.below(2));
    use.sampler = {one_of<TextureWrap>(input, 3), one_of<TextureWrap>(input, 3), one_of<TextureFilter>(input, 2),
                   one_of<TextureFilter>(input, 2), one_of<MipFilter>(input, 3)};
    if (input.one_in(4)) use.row_u = {input.real(), input.real(), input.real()};
    return use;
}

Material read_material(Input& input, std::size_t textures) {
    Material material;
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        if (!input.one_in(3)) continue;
        float values[4];
        for (int c = 0; c < number.count; ++c) values[c] = input.real();
        number.set(material, values);
    }
    material.alpha_mode = one_of<AlphaMode>(input, 3);
    material.double_sided = input.flag();
    material.unlit = input.one_in(8);
    material.lobe = read_lobe(input);
    material.has_own_lobe = input.flag();
    for (TextureUse& use : material.textures)
        if (input.flag()) use = read_texture_use(input, textures);
    return material;
}

Mesh read_mesh(Input& input, std::size_t materials) {
    Mesh mesh;
    const std::size_t vertices = 3 + input.below(8), triangles = 1 + input.below(6);
    for (std::size_t i = 0; i < vertices; ++i) {
        mesh.positions.push_back({input.real(), input.real(), input.real()});
        mesh.normals.push_back({input.real(), input.real(), input.real()});
        mesh.uv0.push_back({input.real(), input.real()});
    }
    for (std::size_t i = 0; i < 3 * triangles; ++i) mesh.indices.push_back(static_cast<std::uint32_t>(input.below(vertices)));
    mesh.uv1 = mesh.uv0;
    if (input.one_in(3)) mesh.colors.assign(vertices, {input.real(), input.real(), input.real(), input.real()});
    mesh.material = static_cast<int>(input.below(materials + 1)) - 1;
    switch (input.below(4)) {
        case 0:
            generate_flat_normals(mesh);
            break;
        case 1:
            generate_tangents(mesh, 0);
            break;
        case 2:
            mesh.normals.clear();
            break;
        default:
            break;
    }
    return mesh;
}

Light read_light(Input& input) {
    Light light;
    light.type = one_of<LightType>(input, 3);
    light.color_linear = {input.real(), input.real(), input.real()};
    light.position_ws = {input.real(), input.real(), input.real()};
    const Vec3f direction{input.real(), input.real(), input.real()};
    light.direction_ws = normalize_or(direction, light.direction_ws);
    if (input.one_in(3)) light.range = input.real();
    if (input.one_in(4)) light.source_radius = input.real();
    if (input.one_in(4)) light.inner_cone_rad = input.real();
    if (input.one_in(4)) light.outer_cone_rad = input.real();
    if (input.one_in(4)) light.cone_power = input.real();
    return light;
}

}  // namespace

RenderFlags read_flags(Input& input) {
    RenderFlags flags;
    flags.width = 1 + static_cast<int>(input.below(64));
    flags.height = 1 + static_cast<int>(input.below(64));
    flags.padding = input.below(3);
    flags.bgra = input.one_in(4);
    flags.premultiplied = input.one_in(4);
    flags.planes = input.one_in(2);
    flags.own_camera = input.one_in(4);
    flags.environment = input.one_in(8);
    flags.scalar_twin = input.one_in(3);
    flags.frame_twin = input.one_in(8);
    flags.tile_size = input.pick(std::array{16, 32, 64});
    flags.settings = read_settings(input, flags);
    // Direct integration over an environment takes seconds for each lobe.
    if (flags.environment && flags.settings.shading.accuracy == Accuracy::reference) flags.settings.shading.accuracy = Accuracy::exact;
    if (flags.own_camera) flags.camera = read_camera(input);
    flags.settings.tone_curve = one_of<ToneCurve>(input, 4);
    return flags;
}

EnvironmentImage small_environment(Input& input) {
    EnvironmentImage image{8, 4, {}, false};
    for (int i = 0; i < 8 * 4 * 3; ++i) image.rgb.push_back(static_cast<float>(input.byte()) / 64.0f);
    image.rgb[input.below(image.rgb.size())] *= 100.0f;
    return image;
}

Scene scene_by_code(Input& input) {
    Scene scene;
    const std::size_t textures = 1 + input.below(2), materials = 1 + input.below(3), meshes = 1 + input.below(3);
    for (std::size_t i = 0; i < textures; ++i) {
        const int width = 1 + static_cast<int>(input.below(5)), height = 1 + static_cast<int>(input.below(5));
        Bytes rgba;
        for (int k = 0; k < 4 * width * height; ++k) rgba.push_back(input.byte());
        scene.textures.push_back(*Texture::from_rgba8(rgba, width, height, input.flag() ? ColorSpace::srgb : ColorSpace::linear));
    }
    for (std::size_t i = 0; i < materials; ++i) scene.materials.push_back(read_material(input, textures));
    for (std::size_t i = 0; i < meshes; ++i) scene.meshes.push_back(read_mesh(input, materials));
    for (std::size_t i = 0, count = 1 + input.below(5); i < count; ++i) {
        Instance instance;
        instance.mesh = static_cast<int>(input.below(meshes));
        if (input.one_in(2)) instance.world_from_object = look_at({input.real(), input.real(), input.real()}, {0, 0, 0}, {0, 1, 0});
        scene.instances.push_back(instance);
    }
    for (std::size_t i = 0, count = input.below(4); i < count; ++i) scene.lights.push_back(read_light(input));
    return scene;
}

}  // namespace halflit::fuzz
