#include "apps/engine/request/kept_view.hpp"

#include "apps/engine/basics/printable.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/given_camera.hpp"
#include "raster/detail/view_math.hpp"
#include "raster/view/depth_range.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace halflit::engine {
namespace {

constexpr double kFarthestNumber = 1e38;  // the range of the floats that a camera has

/// The keys of a view in the order of its text. visit(name, numbers): a number, or three.
template <class View, class Visit>
void each_key(View& view, const Visit& visit) {
    const auto point = [&](const char* name, auto& p) { visit(name, std::vector{&p.x, &p.y, &p.z}); };
    point("eye", view.eye);
    point("right", view.right);
    point("up", view.up);
    point("back", view.back);
    if (view.orthographic)
        visit("half_height", std::vector{&view.half_height});
    else
        visit("fov_y_rad", std::vector{&view.fov_y_rad});
    visit("near", std::vector{&view.near_z});
    visit("far", std::vector{&view.far_z});
    if (!view.empty) point("low", view.low), point("high", view.high);
    visit("point_size", std::vector{&view.point_size});
    point("background", view.background);
}

}  // namespace

KeptView kept_view(const Camera& camera, const Bounds& bounds, const Settings& settings, const Placement& placement) {
    const GivenCamera given = in_file(camera, placement);
    KeptView view;
    view.eye = given.eye, view.right = given.right, view.up = given.up, view.back = given.back;
    view.orthographic = camera.orthographic;
    if (camera.orthographic)
        view.half_height = given.lens.half_height;
    else
        view.fov_y_rad = given.lens.fov_y_rad;
    view.near_z = given.lens.near_z, view.far_z = given.lens.far_z;
    view.empty = bounds.empty;
    if (!bounds.empty) view.low = placement.out(to_double(bounds.min)), view.high = placement.out(to_double(bounds.max));
    view.point_size = settings.point_size;
    const Vec4f& background = settings.background_linear;
    view.background = {background.x, background.y, background.z};
    return view;
}

Camera camera_of(const KeptView& view, const Placement& placement, const Bounds& bounds) {
    const double scale = placement.scale;
    const Vec3d eye = placement.into(view.eye), back = turned_upright(view.back, placement.up);
    const auto direction = [&](Vec3d v) { return raster::column(turned_upright(v, placement.up), 0); };
    Camera camera;
    camera.world_from_camera = {{direction(view.right), direction(view.up), raster::column(back, 0), raster::column(eye, 1)}};
    camera.orthographic = view.orthographic;
    if (view.orthographic)
        camera.half_height = static_cast<float>(view.half_height * scale);
    else
        camera.fov_y_rad = static_cast<float>(view.fov_y_rad);
    double near_z = view.near_z * scale, far_z = view.far_z * scale;
    if (!bounds.empty) {
        const auto [nearest, farthest] = raster::DepthSpan(eye, back, bounds);
        if (view.orthographic) {
            const double room = 1e-3 * (far_z - near_z);
            if (nearest < near_z + room) near_z = nearest - room;
            if (farthest > far_z - room) far_z = farthest + room;
        } else if (nearest < near_z) {
            near_z = std::max(nearest / 2, 1e-3 * near_z);
        }
    }
    camera.near_z = static_cast<float>(near_z), camera.far_z = static_cast<float>(far_z);
    return camera;
}

Bounds bounds_of(const KeptView& view, const Placement& placement) {
    Bounds bounds;
    if (view.empty) return bounds;
    for (const Vec3d corner : {view.low, view.high}) bounds.add(to_float(placement.into(corner)));
    return bounds;
}

std::string kept_view_text(const KeptView& view) {
    std::string text;
    each_key(view, [&](const char* name, const std::vector<const double*>& numbers) {
        text += fmt::format("{}{}=", text.empty() ? "" : " ", name);
        for (std::size_t i = 0; i < numbers.size(); ++i) text += fmt::format("{}{}", i == 0 ? "" : ",", *numbers[i]);
    });
    return text;
}

Result<KeptView> parse_kept_view(std::string_view text) {
    std::vector<std::string> words = words_of(text, ' ');
    KeptView view;
    const auto has = [&](std::string_view key) {
        return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return word.starts_with(key); });
    };
    view.orthographic = has("half_height=");
    view.empty = !has("low=");
    std::string wrong;
    std::size_t place = 0;
    each_key(view, [&](const std::string& name, const std::vector<double*>& numbers) {
        const std::string word = place < words.size() ? words[place++] : "";
        if (!wrong.empty()) return;
        const bool named = word.starts_with(name + "=");
        const std::vector<std::string> values = named ? words_of(word.substr(name.size() + 1), ',') : std::vector<std::string>{};
        bool good = values.size() == numbers.size();
        for (std::size_t i = 0; good && i < values.size(); ++i) {
            const char* const last = values[i].data() + values[i].size();
            const auto [end, error] = std::from_chars(values[i].data(), last, *numbers[i]);
            good = error == std::errc() && end == last && std::abs(*numbers[i]) <= kFarthestNumber;
        }
        if (!good)
            wrong =
                fmt::format("expected {}= and {}, found '{}'", name, numbers.size() == 1 ? "a number" : "three numbers", printable(word));
    });
    if (wrong.empty() && place < words.size()) wrong = fmt::format("expected no more keys, found '{}'", printable(words[place]));
    if (!wrong.empty()) return fail(ErrorCode::bad_input, wrong);
    return view;
}

}  // namespace halflit::engine
