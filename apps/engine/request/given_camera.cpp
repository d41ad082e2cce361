#include "apps/engine/request/given_camera.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "raster/detail/view_math.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace halflit::engine {

Vec3d drawn_at(Vec3d point, const Placement& placement) {
    const auto within = [](double x) { return std::clamp(x, -io::kLargestLength, io::kLargestLength); };
    const Vec3d at = placement.into(point);
    return {within(at.x), within(at.y), within(at.z)};
}

Camera placed(const GivenCamera& given, const Placement& placement, const Bounds& bounds) {
    Camera camera = given.lens;
    camera.name = given.name;
    const auto axis = [&](Vec3d v) { return raster::column(turned_upright(v, placement.up), 0); };
    camera.world_from_camera = {{axis(given.right), axis(given.up), axis(given.back), raster::column(drawn_at(given.eye, placement), 1)}};
    io::scale_lengths(camera, placement.scale);
    return completed(std::move(camera), bounds);
}

GivenCamera in_file(const Camera& camera, const Placement& placement) {
    GivenCamera given{.name = camera.name, .lens = camera};
    const auto vector = [&](std::size_t i) {
        const Vec4f& column = camera.world_from_camera.c[i];
        return Vec3d{column.x, column.y, column.z};
    };
    given.right = turned_back(vector(0), placement.up);
    given.up = turned_back(vector(1), placement.up);
    given.back = turned_back(vector(2), placement.up);
    given.eye = placement.out(vector(3));
    io::scale_lengths(given.lens, 1.0 / placement.scale);
    return given;
}

Result<GivenCamera> camera_of(const Intrinsics& intrinsics, const std::array<double, 9>& rotation,
                              const std::array<double, 3>& translation) {
    auto lens = Camera::from_intrinsics(intrinsics, rotation, translation);
    if (!lens) return tl::unexpected(lens.error());
    GivenCamera camera{.lens = std::move(*lens), .size = PictureSize{intrinsics.width, intrinsics.height}};
    const auto& r = rotation;
    camera.right = {r[0], r[1], r[2]};
    camera.up = Vec3d{r[3], r[4], r[5]} * -1.0;
    camera.back = Vec3d{r[6], r[7], r[8]} * -1.0;
    const auto& [x, y, z] = translation;
    camera.eye = (camera.right * -x + camera.up * y) + camera.back * z;
    return camera;
}

Result<void> put_at(GivenCamera& camera, const std::array<double, 16>& m) {
    constexpr double kRounding = 1e-6;
    if (absolute(m[12]) + absolute(m[13]) + absolute(m[14]) > kRounding || absolute(m[15] - 1.0) > kRounding)
        return fail(ErrorCode::usage, "matrix: expected 0, 0, 0, 1 as the last row; the numbers are given row by row");
    constexpr double kMost = 1e30;
    for (const std::size_t i : {3, 7, 11})
        if (!(absolute(m[i]) < kMost)) return fail(ErrorCode::usage, "matrix: expected a place within 1e30 of the origin");
    const Intrinsics any{1, 1, 0, 0, 1, 1, 0};
    if (auto rigid = camera_of(any, {m[0], m[4], m[8], -m[1], -m[5], -m[9], -m[2], -m[6], -m[10]}, {0, 0, 0}); !rigid)
        return tl::unexpected(rigid.error());
    camera.right = {m[0], m[4], m[8]};
    camera.up = {m[1], m[5], m[9]};
    camera.back = {m[2], m[6], m[10]};
    camera.eye = {m[3], m[7], m[11]};
    return {};
}

Result<std::size_t> find_camera(const CameraFile& file, const std::string& wanted) {
    if (wanted.empty()) return 0;
    for (std::size_t i = 0; i < file.cameras.size(); ++i)
        if (file.cameras[i].name == wanted) return i;
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < file.cameras.size()) return index;
    return fail(ErrorCode::usage, fmt::format("--camera: expected an index below {}, the name of a camera of {}, or all, found '{}'",
                                              file.cameras.size(), file.path, io::printable(wanted)));
}

}  // namespace halflit::engine
