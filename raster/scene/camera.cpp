// Cameras by calibrations, and the check of a camera.
#include "halflit/camera.hpp"

#include "raster/detail/view_math.hpp"
#include "sh/fp_environment.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

namespace halflit {
namespace {

double determinant(Vec3d a, Vec3d b, Vec3d c) { return dot(a, cross(b, c)); }

constexpr const char* kMirrors = "expected a rotation, found a matrix that mirrors: it would show things inside out";

}  // namespace

float Camera::made_for_aspect() const {
    if (sides) return (sides->right - sides->left) / (sides->top - sides->bottom);
    if (orthographic) return half_width > 0.0f && half_height > 0.0f ? half_width / half_height : 0.0f;
    return aspect > 0.0f ? aspect : 0.0f;
}

Result<Camera> Camera::from_intrinsics(const Intrinsics& lens, const std::array<double, 9>& rotation,
                                       const std::array<double, 3>& translation) {
    const FpEnvironment environment_of_host;
    const auto usable = [](double x) { return raster::magnitude(x) < 1e12; };
    if (!(lens.fx > 0 && lens.fy > 0 && usable(lens.fx) && usable(lens.fy) && usable(lens.cx) && usable(lens.cy) &&
          usable(lens.first_pixel)))
        return fail(ErrorCode::usage, "intrinsics: expected fx and fy above 0, and finite numbers");
    if (lens.width < 1 || lens.height < 1) return fail(ErrorCode::usage, "intrinsics: the picture has no pixels");
    const Vec3d rows[] = {
        {rotation[0], rotation[1], rotation[2]}, {rotation[3], rotation[4], rotation[5]}, {rotation[6], rotation[7], rotation[8]}};
    constexpr double kRigid = 1e-3;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(raster::magnitude(dot(rows[i], rows[j]) - (i == j ? 1.0 : 0.0)) < kRigid))
                return fail(ErrorCode::usage, "rotation: expected rows of length 1 at right angles to each other");
    if (determinant(rows[0], rows[1], rows[2]) < 0) return fail(ErrorCode::usage, std::string("rotation: ") + kMirrors);
    const Vec3d t{translation[0], translation[1], translation[2]};
    if (!(usable(t.x) && usable(t.y) && usable(t.z))) return fail(ErrorCode::usage, "translation: expected finite numbers");
    const Vec3d eye = ((rows[0] * t.x + rows[1] * t.y) + rows[2] * t.z) * -1.0;
    Camera camera;
    camera.world_from_camera = {
        {raster::column(rows[0], 0), raster::column(rows[1] * -1.0, 0), raster::column(rows[2] * -1.0, 0), raster::column(eye, 1)}};
    // The first pixel's corner is half a pixel before its middle.
    const double first = lens.first_pixel - 0.5;
    const auto tangent = [](double pixel, double centre, double f) { return static_cast<float>((pixel - centre) / f); };
    camera.sides = ViewSides{tangent(first, lens.cx, lens.fx), tangent(first + lens.width, lens.cx, lens.fx),
                             -tangent(first + lens.height, lens.cy, lens.fy), -tangent(first, lens.cy, lens.fy)};
    if (auto ok = check_camera(camera); !ok) return tl::unexpected<Error>(ok.error());
    return camera;
}

Camera completed(Camera camera, const Bounds& scene) {
    const FpEnvironment environment_of_host;
    if (camera.orthographic || camera.near_z != 0.0f) return camera;
    constexpr float kNearestShare = 1e-4f;  // of the distance to the scene's centre or of its radius
    constexpr float kClear = 0.25f;         // of the distance to the scene's box: the corners of the widest view lie nearer along the axis
    camera.near_z = 0.1f;
    if (scene.empty) return camera;
    const Vec4f &back = camera.world_from_camera.c[2], &place = camera.world_from_camera.c[3];
    const Vec3f eye{place.x, place.y, place.z};
    const auto beside = [](float at, float low, float high) { return at < low ? low - at : at > high ? at - high : 0.0f; };
    const float distance = length(
        Vec3f{beside(eye.x, scene.min.x, scene.max.x), beside(eye.y, scene.min.y, scene.max.y), beside(eye.z, scene.min.z, scene.max.z)});
    float nearest = 3e38f;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3f p{corner & 1 ? scene.max.x : scene.min.x, corner & 2 ? scene.max.y : scene.min.y,
                      corner & 4 ? scene.max.z : scene.min.z};
        const float depth = dot(eye - p, Vec3f{back.x, back.y, back.z});
        if (depth < nearest) nearest = depth;
    }
    const float away = length(scene.center() - eye), radius = scene.radius(), size = away > radius ? away : radius;
    const float clear = distance > 0.0f ? kClear * distance : 3e38f, share = kNearestShare * size;
    const float half_way = nearest / 2, least = clear < share ? clear : share, near_z = half_way > least ? half_way : least;
    if (near_z > 0.0f && near_z < 3e38f) camera.near_z = near_z;
    return camera;
}

Result<void> check_camera(const Camera& camera) {
    const FpEnvironment environment_of_host;
    const Mat4& m = camera.world_from_camera;
    if (determinant3(m) < 0)
        return fail(ErrorCode::usage, std::string("camera: ") + kMirrors +
                                          " (cameras of computer vision look along +z with y down: from_intrinsics takes them)");
    constexpr double kRigid = 1e-2;  // of float32 matrices that were multiplied often
    for (std::size_t k = 0; k < 3; ++k)
        if (const double size = length(axis(m, static_cast<int>(k))); raster::finite(size) && (size > 1 + kRigid || size < 1 - kRigid))
            return fail(ErrorCode::usage, "camera: the matrix scales, expected a rotation and a translation");
    if (camera.sides) {
        const ViewSides& s = *camera.sides;
        if (!(s.left < s.right && s.bottom < s.top && raster::finite(s.right - s.left) && raster::finite(s.top - s.bottom)))
            return fail(ErrorCode::usage, "camera: expected sides with left below right and bottom below top");
    }
    return {};
}

}  // namespace halflit
