// Cameras of JSON: halflit's own objects and its reports, and transforms.json of NeRF, instant-ngp and Nerfstudio.
#include "apps/engine/request/camera_file.hpp"
#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace halflit::engine::detail {
namespace {

using CameraJson = nlohmann::ordered_json;
constexpr int kMostDepth = 32;

/// Reads values of one object, or of a second one where the first lacks them. The first error stays.
class CameraValues {
public:
    explicit CameraValues(const CameraJson& object, const CameraJson* shared = nullptr) : object_(object), shared_(shared) {}

    [[nodiscard]] const CameraJson* find(const char* key) const {
        if (const auto own = object_.find(key); own != object_.end()) return &*own;
        if (shared_ == nullptr) return nullptr;
        const auto other = shared_->find(key);
        return other != shared_->end() ? &*other : nullptr;
    }
    /// A finite number in a range.
    [[nodiscard]] std::optional<double> number(const char* key, double low, double high) {
        const CameraJson* const value = find(key);
        if (value == nullptr || value->is_null()) return std::nullopt;
        const double found = value->is_number() ? value->get<double>() : std::nan("");
        if (found >= low && found <= high) return found;
        wrong(key, fmt::format("a number from {:g} to {:g}", low, high));
        return std::nullopt;
    }
    /// N finite numbers, which may be in rows.
    template <std::size_t N>
    [[nodiscard]] std::optional<std::array<double, N>> numbers(const char* key) {
        const CameraJson* const value = find(key);
        if (value == nullptr) return std::nullopt;
        std::array<double, N> out{};
        std::size_t count = 0;
        const auto add = [&](const CameraJson& one) {
            const double found = one.is_number() ? one.get<double>() : std::nan("");
            if (count < N && found - found == 0.0) out[count] = found;
            count += found - found == 0.0 ? 1 : N + 1;
        };
        for (const CameraJson& one : value->is_array() && value->size() <= N ? *value : CameraJson::array()) {
            if (!one.is_array() || one.size() > N)
                add(one);
            else
                std::for_each(one.begin(), one.end(), add);
        }
        if (count == N) return out;
        wrong(key, fmt::format("{} finite numbers", N));
        return std::nullopt;
    }
    [[nodiscard]] bool truth(const char* key) {
        const CameraJson* const value = find(key);
        if (value == nullptr) return false;
        if (!value->is_boolean()) wrong(key, "true or false");
        return value->is_boolean() && value->get<bool>();
    }
    [[nodiscard]] std::string text(const char* key) {
        const CameraJson* const value = find(key);
        if (value == nullptr) return "";
        if (!value->is_string()) wrong(key, "a text");
        return value->is_string() ? value->get<std::string>() : "";
    }
    void wrong(const char* key, const std::string& expected) {
        const CameraJson* const value = find(key);
        if (result_)
            result_ = fail(
                ErrorCode::bad_input,
                fmt::format("{}: expected {}, found {}", key, expected,
                            value == nullptr        ? "nothing"
                            : value->is_primitive() ? io::printable(value->dump(-1, ' ', true, CameraJson::error_handler_t::replace), 80)
                                                    : value->type_name()));
    }
    [[nodiscard]] const Result<void>& result() const { return result_; }

private:
    const CameraJson& object_;
    const CameraJson* shared_;
    Result<void> result_;
};

constexpr double kMostLength = 1e30, kMostPixels = 1e9;

/// The picture's size by two members.
Result<std::optional<PictureSize>> size_of(CameraValues& values, const char* width, const char* height) {
    const auto w = values.number(width, 1, kMostPixels), h = values.number(height, 1, kMostPixels);
    if (!values.result()) return tl::unexpected(values.result().error());
    if (!w || !h) return std::optional<PictureSize>();
    const auto size = checked_size(*w, *h);
    if (!size) return tl::unexpected(size.error());
    return std::optional(*size);
}

constexpr std::array<double, 9> kNoTurn{1, 0, 0, 0, 1, 0, 0, 0, 1};

/// The camera's lens. Angles and heights of halflit's own cameras come before K, which cannot say every picture's shape.
Result<GivenCamera> lens_of_own(CameraValues& values) {
    const bool orthographic = values.truth("orthographic");
    const auto size = size_of(values, "width", "height");
    if (!size) return tl::unexpected(size.error());
    const auto fov = orthographic ? std::nullopt : values.number("fov_y_deg", 1e-3, 179.9);
    const auto half_height = orthographic ? values.number("half_height", 1e-30, kMostLength) : std::nullopt;
    GivenCamera camera;
    if (!fov && !half_height) {
        const auto k = values.numbers<9>("k");
        if (!values.result()) return tl::unexpected(values.result().error());
        if (!k || !*size)
            return fail(ErrorCode::bad_input, orthographic ? "expected half_height, or k with width and height"
                                                           : "expected fov_y_deg, or k with width and height");
        const auto& [fx, skew, cx, zero_a, fy, cy, zero_b, zero_c, one] = *k;
        if (skew != 0 || zero_a != 0 || zero_b != 0 || zero_c != 0 || one != 1)
            return fail(ErrorCode::bad_input, "k: expected fx, 0, cx, 0, fy, cy, 0, 0, 1");
        auto made = camera_of({fx, fy, cx, cy, (*size)->width, (*size)->height, 0.5}, kNoTurn, {0, 0, 0});
        if (!made) return made;
        camera = std::move(*made);
    }
    camera.size = *size;
    Camera& lens = camera.lens;
    lens.orthographic = orthographic;
    if (fov) lens.fov_y_rad = static_cast<float>(*fov * (kPi / 180.0));
    if (half_height) lens.half_height = static_cast<float>(*half_height);
    if (fov) lens.aspect = static_cast<float>(values.number("aspect", 0, 1e6).value_or(0));
    if (half_height) lens.half_width = static_cast<float>(values.number("half_width", 0, kMostLength).value_or(0));
    lens.near_z = static_cast<float>(values.number("near", orthographic ? -kMostLength : 0, kMostLength).value_or(0));
    lens.far_z = static_cast<float>(values.number("far", 0, kMostLength).value_or(0));
    return camera;
}

Result<GivenCamera> own_camera(const CameraJson& object) {
    CameraValues values(object);
    auto camera = lens_of_own(values);
    if (!camera) return camera;
    camera->name = values.text("name");
    const auto matrix = values.numbers<16>("world_from_camera");
    const auto r = values.numbers<9>("r");
    const auto t = values.numbers<3>("t");
    if (!values.result()) return tl::unexpected(values.result().error());
    if (matrix) {
        if (const auto put = put_at(*camera, *matrix); !put) return tl::unexpected(put.error());
        return camera;
    }
    if (!r || !t) return fail(ErrorCode::bad_input, "expected world_from_camera, or r and t");
    const auto place = camera_of({1, 1, 0, 0, 1, 1, 0}, *r, *t);
    if (!place) return place;
    camera->right = place->right, camera->up = place->up, camera->back = place->back, camera->eye = place->eye;
    return camera;
}

/// The lens of a frame of transforms.json. Pixels have their corners at whole numbers.
Result<GivenCamera> lens_of_frame(CameraValues& values) {
    const auto size = size_of(values, "w", "h");
    if (!size) return tl::unexpected(size.error());
    const auto angle_x = values.number("camera_angle_x", 1e-5, 3.14), angle_y = values.number("camera_angle_y", 1e-5, 3.14);
    const auto fl_x = values.number("fl_x", 1e-6, kMostPixels), fl_y = values.number("fl_y", 1e-6, kMostPixels);
    const auto cx = values.number("cx", -kMostPixels, kMostPixels), cy = values.number("cy", -kMostPixels, kMostPixels);
    if (!values.result()) return tl::unexpected(values.result().error());
    if (!fl_x && !angle_x) return fail(ErrorCode::bad_input, "expected fl_x or camera_angle_x");
    if (!*size) {
        if (!angle_x) return fail(ErrorCode::bad_input, "w, h: expected the size of the pictures beside fl_x");
        GivenCamera wide;
        wide.lens.fov_y_rad = static_cast<float>(*angle_x);
        wide.lens.aspect = 1.0f;  // as the pictures of such data sets are, unless --size says otherwise
        wide.horizontal_fov = true;
        wide.lens.near_z = 0.0f;
        return wide;
    }
    const double width = (*size)->width, height = (*size)->height;
    const auto focal_length = [](double side, double angle) {
        const SinCos half = sin_cos(0.5 * angle);
        return 0.5 * side * half.cos / half.sin;
    };
    const double fx = fl_x ? *fl_x : focal_length(width, *angle_x);
    const double fy = fl_y ? *fl_y : angle_y && !fl_x ? focal_length(height, *angle_y) : fx;
    return camera_of({fx, fy, cx.value_or(0.5 * width), cy.value_or(0.5 * height), (*size)->width, (*size)->height, 0.5}, kNoTurn,
                     {0, 0, 0});
}

Result<GivenCamera> frame_camera(const CameraJson& frame, const CameraJson& shared, bool& distorted) {
    CameraValues values(frame, &shared);
    auto camera = lens_of_frame(values);
    if (!camera) return camera;
    for (const char* const term : {"k1", "k2", "k3", "k4", "p1", "p2"})
        distorted |= values.number(term, -kMostPixels, kMostPixels).value_or(0) != 0;
    camera->name = values.text("file_path");
    const auto matrix = values.numbers<16>("transform_matrix");
    if (!values.result()) return tl::unexpected(values.result().error());
    if (!matrix) return fail(ErrorCode::bad_input, "expected transform_matrix");
    if (const auto put = put_at(*camera, *matrix); !put) return tl::unexpected(put.error());
    return camera;
}

/// The text as JSON, nested no deeper than the limit.
Result<CameraJson> parsed_json(std::string_view text) {
    try {
        TimeCheck check;
        return CameraJson::parse(text, [&](int depth, CameraJson::parse_event_t, CameraJson&) {
            check();
            if (depth > kMostDepth) throw std::length_error(fmt::format("nested deeper than {} levels", kMostDepth));
            return true;
        });
    } catch (const std::length_error& error) {
        return fail(ErrorCode::limit, error.what());
    } catch (const CameraJson::exception& exception) {
        const std::string what = exception.what();  // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        return fail(ErrorCode::bad_input, io::printable(what.substr(std::min(what.find("] ") + 2, what.size()))));
    }
}

/// A report of look, render or compare: it has cameras of its own, or of its views.
bool is_report(const CameraJson& json) {
    return json.is_object() && json.contains("schema") && !json.contains("frames") && !json.contains("world_from_camera");
}

/// Adds the cameras of a report. A view's camera takes its name; a picture's camera without a name takes that of the picture.
Result<void> add_of_report(const CameraJson& report, CameraFile& into) {
    const auto add = [&](const CameraJson& object, const std::string& place, const char* name, bool instead) -> Result<void> {
        const auto found = object.find("camera");
        if (found == object.end()) return {};
        if (!found->is_object()) return fail(ErrorCode::bad_input, place + "camera: expected an object");
        if (into.cameras.size() == kMostCameras) return fail(ErrorCode::limit, fmt::format("more than {} cameras", kMostCameras));
        auto camera = own_camera(*found);
        if (!camera) return fail(camera.error().code, place + "camera: " + camera.error().message);
        const auto named = object.find(name);
        if (named != object.end() && named->is_string() && (instead || camera->name.empty())) camera->name = named->get<std::string>();
        into.cameras.push_back(std::move(*camera));
        return {};
    };
    if (const auto added = add(report, "", "output", false); !added) return added;
    const auto views = report.find("views");
    if (views == report.end() || !views->is_array()) return {};
    for (std::size_t i = 0; i < views->size(); ++i) {
        check_time();
        if (!(*views)[i].is_object()) continue;
        if (const auto added = add((*views)[i], fmt::format("views[{}].", i), "name", true); !added) return added;
    }
    return {};
}

/// Reports of several pictures, one a line.
Result<void> add_of_lines(std::string_view text, CameraFile& into) {
    for (std::size_t number = 1; !text.empty(); ++number) {
        check_time();
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        const auto json = parsed_json(line);
        const auto added = !json              ? Result<void>(tl::unexpected(json.error()))
                           : is_report(*json) ? add_of_report(*json, into)
                                              : Result<void>(fail(ErrorCode::bad_input, "expected a report"));
        if (!added) return fail(added.error().code, fmt::format("line {}: {}", number, added.error().message));
    }
    return {};
}

/// The first line is an object of its own, and another line follows it.
bool has_lines_of_reports(std::string_view text) {
    const std::size_t end = text.find('\n');
    return text.starts_with("{\"schema\":\"halflit.") && end != std::string_view::npos &&
           text.find_first_not_of(" \t\r\n", end) != std::string_view::npos;
}

}  // namespace

Result<void> read_json_cameras(std::string_view text, CameraFile& into) {
    if (has_lines_of_reports(text)) return add_of_lines(text, into);
    const auto json = parsed_json(text);
    if (!json) return tl::unexpected(json.error());
    if (is_report(*json)) return add_of_report(*json, into);
    const bool frames = json->is_object() && json->contains("frames");
    const CameraJson& list = frames ? (*json)["frames"] : *json;
    if (frames && !list.is_array()) return fail(ErrorCode::bad_input, "frames: expected a list");
    if (list.is_array() && list.size() > kMostCameras) return fail(ErrorCode::limit, fmt::format("more than {} cameras", kMostCameras));
    bool distorted = false;
    const std::size_t count = list.is_array() ? list.size() : 1;
    for (std::size_t i = 0; i < count; ++i) {
        check_time();
        const CameraJson& one = list.is_array() ? list[i] : list;
        const std::string place = list.is_array() ? fmt::format("{}[{}]: ", frames ? "frames" : "", i) : "";
        if (!one.is_object()) return fail(ErrorCode::bad_input, place + "expected an object");
        auto camera = frames ? frame_camera(one, *json, distorted) : own_camera(one);
        if (!camera) return fail(camera.error().code, place + camera.error().message);
        into.cameras.push_back(std::move(*camera));
    }
    if (distorted) into.warnings.push_back(into.path + ": " + kDistorted);
    return {};
}

}  // namespace halflit::engine::detail
