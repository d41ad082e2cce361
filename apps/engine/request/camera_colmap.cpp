// Cameras of COLMAP's text model. images.txt has two lines for each picture: its quaternion, translation, camera and name, and its points.
#include "apps/engine/request/camera_file.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <map>

namespace halflit::engine::detail {
namespace {

/// Parameters of a model of lenses: focal lengths, then cx and cy, then distortion.
struct LensModel {
    std::string_view name;
    std::size_t focal_lengths, parameters;
};
constexpr LensModel kLensModels[] = {{"SIMPLE_PINHOLE", 1, 3},
                                     {"PINHOLE", 2, 4},
                                     {"SIMPLE_RADIAL", 1, 4},
                                     {"RADIAL", 1, 5},
                                     {"OPENCV", 2, 8},
                                     {"OPENCV_FISHEYE", 2, 8},
                                     {"FULL_OPENCV", 2, 12},
                                     {"FOV", 2, 5},
                                     {"SIMPLE_RADIAL_FISHEYE", 1, 4},
                                     {"RADIAL_FISHEYE", 1, 5},
                                     {"THIN_PRISM_FISHEYE", 2, 12}};

/// Takes the lines of a text.
class ColmapLines {
public:
    explicit ColmapLines(std::string_view text) : text_(text) {}
    /// False at the end.
    bool next(std::string_view& line) {
        check_time();
        if (text_.empty()) return false;
        const std::size_t end = std::min(text_.find('\n'), text_.size());
        line = text_.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        text_.remove_prefix(std::min(end + 1, text_.size()));
        ++number_;
        return true;
    }
    [[nodiscard]] std::size_t number() const { return number_; }

private:
    std::string_view text_;
    std::size_t number_ = 0;
};

std::string_view next_word(std::string_view& line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

/// A finite number at the line's begin; NaN: there is none.
double next_number(std::string_view& line) {
    const double value = io::detail::parse_real<double>(next_word(line)).value_or(std::nan(""));
    return value - value == 0.0 ? value : std::nan("");
}

bool is_skipped(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string_view::npos || line[first] == '#';
}

struct ColmapLens {
    Intrinsics intrinsics;
    bool distorted = false;
};
using Lenses = std::map<std::string, ColmapLens, std::less<>>;

Result<ColmapLens> lens_of(std::string_view line) {
    const std::string_view name = next_word(line);
    const LensModel* model = nullptr;
    for (const LensModel& one : kLensModels)
        if (one.name == name) model = &one;
    if (model == nullptr) return fail(ErrorCode::bad_input, "unknown model of a lens, '" + io::printable(name, 40) + "'");
    const double width = next_number(line), height = next_number(line);
    const auto size = checked_size(width, height);
    if (!size) return tl::unexpected(size.error());
    std::array<double, 12> p{};
    for (std::size_t i = 0; i < model->parameters; ++i)
        if (p[i] = next_number(line); p[i] != p[i])
            return fail(ErrorCode::bad_input, fmt::format("expected {} numbers after {} and the size", model->parameters, name));
    const std::size_t focal = model->focal_lengths;
    ColmapLens lens{{p[0], p[focal - 1], p[focal], p[focal + 1], size->width, size->height, 0.5}};
    for (std::size_t i = focal + 2; i < model->parameters; ++i) lens.distorted |= p[i] != 0.0;
    return lens;
}

Result<Lenses> lenses_of(std::string_view text) {
    Lenses lenses;
    ColmapLines lines(text);
    for (std::string_view line; lines.next(line);) {
        if (is_skipped(line)) continue;
        const std::string_view id = next_word(line);
        const auto lens = lens_of(line);
        if (!lens) return fail(lens.error().code, fmt::format("cameras.txt, line {}: {}", lines.number(), lens.error().message));
        if (lenses.size() >= kMostCameras) return fail(ErrorCode::limit, fmt::format("more than {} cameras", kMostCameras));
        lenses.insert_or_assign(std::string(id), *lens);
    }
    return lenses;
}

/// R of a quaternion of any length, row by row.
std::array<double, 9> rotation_of(double w, double x, double y, double z) {
    const double length = std::sqrt(((w * w + x * x) + y * y) + z * z);
    w /= length, x /= length, y /= length, z /= length;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),    1 - 2 * (x * x + z * z),
            2 * (y * z - w * x),     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
}

Result<GivenCamera> image_of(std::string_view line, const Lenses& lenses, bool& distorted) {
    (void)next_word(line);  // the picture's number
    std::array<double, 7> p{};
    for (double& number : p)
        if (number = next_number(line); number != number)
            return fail(ErrorCode::bad_input, "expected IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME");
    const std::string_view id = next_word(line);
    const auto lens = lenses.find(id);
    if (lens == lenses.end()) return fail(ErrorCode::bad_input, "camera '" + io::printable(id, 40) + "' is not in cameras.txt");
    auto camera = camera_of(lens->second.intrinsics, rotation_of(p[0], p[1], p[2], p[3]), {p[4], p[5], p[6]});
    if (!camera) return tl::unexpected(camera.error());
    const std::size_t name = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
    if (name != std::string_view::npos) camera->name = line.substr(name, end + 1 - name);
    distorted |= lens->second.distorted;
    return camera;
}

}  // namespace

Result<void> read_colmap_cameras(std::string_view images, std::string_view cameras, CameraFile& into) {
    const auto lenses = lenses_of(cameras);
    if (!lenses) return tl::unexpected(lenses.error());
    bool distorted = false;
    ColmapLines lines(images);
    for (std::string_view line; lines.next(line);) {
        if (is_skipped(line)) continue;
        auto camera = image_of(line, *lenses, distorted);
        if (!camera) return fail(ErrorCode::bad_input, fmt::format("line {}: {}", lines.number(), camera.error().message));
        if (into.cameras.size() >= kMostCameras) return fail(ErrorCode::limit, fmt::format("more than {} cameras", kMostCameras));
        into.cameras.push_back(std::move(*camera));
        (void)lines.next(line);  // the picture's points, a line that may be empty
    }
    if (distorted) into.warnings.push_back(into.path + ": " + kDistorted);
    return {};
}

}  // namespace halflit::engine::detail
