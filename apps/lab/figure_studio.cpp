#include "apps/lab/figure_studio.hpp"

#include "apps/lab/figure_bust.hpp"
#include "halflit/shapes.hpp"

namespace halflit::cli {

Shot empty_shot() {
    Shot shot;
    shot.settings.samples = 8;
    shot.settings.background_linear = {0.035f, 0.04f, 0.05f, 1.0f};
    shot.settings.shading.specular = SpecularModel::none;
    shot.settings.shadows = ShadowMode::off;
    return shot;
}

Camera front_camera(float half_height, Vec3f center) {
    Camera camera;
    camera.orthographic = true;
    camera.half_height = half_height;
    camera.near_z = 1.0f;
    camera.far_z = 40.0f;
    camera.world_from_camera = translation(center + Vec3f{0, 0, 20});
    return camera;
}

Material matte(const Lobe& lobe, Vec3f color) {
    Material material;
    material.base_color = {color.x, color.y, color.z, 1};
    material.metallic = 0.0f;
    material.lobe = lobe;
    return material;
}

Light light_from(Vec3f direction, float strength) {
    Light light;
    light.direction_ws = normalize_or(direction * -1.0f, {0, -1, 0});
    light.color_linear = {strength, strength, strength};
    return light;
}

void add_object(Shot& shot, Mesh mesh, Material material, Vec3f place) {
    mesh.material = static_cast<int>(shot.scene.materials.size());
    shot.scene.materials.push_back(std::move(material));
    shot.scene.instances.push_back({static_cast<int>(shot.scene.meshes.size()), translation(place)});
    shot.scene.meshes.push_back(std::move(mesh));
}

Shot shot_of(Subject subject, const Lobe& lobe, Vec3f color) {
    static const Mesh sphere = make_sphere(1.0f, 128, 64), bust = make_bust();
    Shot shot = empty_shot();
    add_object(shot, subject == Subject::sphere ? sphere : bust, matte(lobe, color));
    shot.camera = subject == Subject::sphere ? front_camera(1.08f) : front_camera(1.38f, {0, -0.32f, 0});
    return shot;
}

Result<Image> take(const Shot& shot) {
    Image image{shot.width, shot.height, {}, {}};
    const std::size_t values = static_cast<std::size_t>(shot.width) * static_cast<std::size_t>(shot.height) * 4;
    image.rgba8.resize(values);
    image.rgba_linear.resize(values);
    const auto report =
        render(shot.scene, shot.camera, shot.settings, {image.width, image.height, image.rgba8.data(), image.rgba_linear.data()});
    if (!report) return tl::unexpected(report.error());
    return image;
}

Result<PictureGrid> take_grid(PictureGrid grid, const std::function<Shot(std::size_t row, std::size_t column)>& shot_at) {
    for (std::size_t row = 0; row < grid.rows.size(); ++row)
        for (std::size_t column = 0; column < grid.columns.size(); ++column) {
            auto picture = take(shot_at(row, column));
            if (!picture) return tl::unexpected(picture.error());
            grid.pictures.push_back(std::move(*picture));
        }
    return grid;
}

}  // namespace halflit::cli
