#include "apps/engine/answers/camera_json.hpp"

#include "apps/engine/request/given_camera.hpp"
#include "raster/view/projection.hpp"
#include "sh/trig.hpp"

#include <nlohmann/json.hpp>

namespace halflit::engine {
namespace {

/// The shortest digits that give the same number again; of a float, those that give the same float.
Json exact_number(double value) {
    const auto rounded = static_cast<float>(value);
    return static_cast<double>(rounded) == value ? json_number(rounded) : Json(value);
}

Json exact_row(Vec3d v) { return {exact_number(v.x), exact_number(v.y), exact_number(v.z)}; }

/// Sides of the picture that is drawn: tangents, or lengths by parallel rays.
struct DrawnSides {
    double left, right, bottom, top;
};

DrawnSides drawn_sides(Camera lens, float aspect) {
    if (lens.sides) return {lens.sides->left, lens.sides->right, lens.sides->bottom, lens.sides->top};
    lens.world_from_camera = {};
    double x = 0, y = 0;
    if (lens.orthographic) {
        const Mat4 clip = raster::clip_from_world(lens, aspect);
        x = 1.0 / clip.c[0].x, y = 1.0 / clip.c[1].y;
    } else {
        const raster::ViewRays rays = raster::view_rays(lens, aspect);
        x = rays.right.x, y = rays.up.y;
    }
    return {-x, x, -y, y};
}

/// Adds what says the lens without the picture's size.
void add_lens(Json& json, const Camera& lens) {
    if (lens.sides) return;
    if (lens.orthographic) {
        json["half_height"] = json_number(lens.half_height);
        if (lens.half_width > 0.0f) json["half_width"] = json_number(lens.half_width);
    } else {
        json["fov_y_deg"] = static_cast<double>(lens.fov_y_rad) * (180.0 / kPi);
        if (lens.aspect > 0.0f) json["aspect"] = json_number(lens.aspect);
    }
}

}  // namespace

Json camera_json(const RenderJob& job, const Camera& camera, PictureSize size) {
    const GivenCamera given = in_file(camera, job.source.placement);
    const DrawnSides sides = drawn_sides(given.lens, static_cast<float>(size.width) / static_cast<float>(size.height));
    const double fx = size.width / (sides.right - sides.left), fy = size.height / (sides.top - sides.bottom);
    const Vec3d down = given.up * -1.0, ahead = given.back * -1.0;
    Json json{{"name", given.name}, {"width", size.width}, {"height", size.height}, {"orthographic", given.lens.orthographic}};
    Json& matrix = json["world_from_camera"] = Json::array();
    const auto add_row = [&](double right, double up, double back, double eye) {
        for (const double x : {right, up, back, eye}) matrix.push_back(exact_number(x));
    };
    add_row(given.right.x, given.up.x, given.back.x, given.eye.x);
    add_row(given.right.y, given.up.y, given.back.y, given.eye.y);
    add_row(given.right.z, given.up.z, given.back.z, given.eye.z);
    add_row(0, 0, 0, 1);
    json["k"] = {Json{fx, 0, -sides.left * fx}, Json{0, fy, sides.top * fy}, Json{0, 0, 1}};
    json["r"] = {exact_row(given.right), exact_row(down), exact_row(ahead)};
    json["t"] = exact_row(Vec3d{dot(given.right, given.eye), dot(down, given.eye), dot(ahead, given.eye)} * -1.0);
    add_lens(json, given.lens);
    json["near"] = json_number(given.lens.near_z);
    json["far"] = json_number(given.lens.far_z);
    return json;
}

}  // namespace halflit::engine
