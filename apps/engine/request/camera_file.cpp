#include "apps/engine/request/camera_file.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <memory>
#include <set>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostJsonBytes = std::size_t{32} << 20;

/// The cameras of a model, in its own coordinates.
Result<void> read_model_cameras(std::span<const std::byte> bytes, const LoadOptions& load, CameraFile& into) {
    LoadOptions options;
    options.limits = load.limits;
    options.allow_external = load.allow_external;
    options.threads = load.threads;
    options.up = UpAxis::y;
    options.animation = "none";
    const auto model = load_model_bytes(bytes, into.path, io::folder_of(into.path), options);
    if (!model) return tl::unexpected(model.error());
    if (model->scene.cameras.size() > detail::kMostCameras) return fail(ErrorCode::limit, into.path + ": too many cameras");
    for (const Camera& camera : model->scene.cameras) into.cameras.push_back(in_file(camera, model->placement));
    return {};
}

/// Begins an error with the file's name.
Result<void> of_file(const std::string& path, const Result<void>& done) {
    if (done) return done;
    const ErrorCode code = done.error().code == ErrorCode::usage ? ErrorCode::bad_input : done.error().code;
    return fail(code, path + ": " + done.error().message);
}

Result<void> read_colmap(std::string_view images, CameraFile& into) {
    const std::string beside = path_in(io::folder_of(into.path), "cameras.txt");
    const auto cameras = io::read_file(beside);
    if (!cameras)
        return fail(cameras.error().code,
                    into.path + ": the lenses of COLMAP's images.txt are in another file: " + cameras.error().message);
    return of_file(into.path, detail::read_colmap_cameras(images, io::detail::as_text(*cameras), into));
}

Result<void> read_cameras(std::span<const std::byte> bytes, const LoadOptions& load, CameraFile& into) {
    const auto model = find_model_format(bytes);
    const std::string_view text = io::detail::as_text(bytes);
    // Any JSON object may be taken for glTF, which has this key.
    const bool gltf = model == ModelFormat::gltf && text.find("\"asset\"") != std::string_view::npos;
    if (gltf || model == ModelFormat::glb) return read_model_cameras(bytes, load, into);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const char begin = first == std::string_view::npos ? ' ' : text[first];
    if (begin == '{' || begin == '[') {
        if (text.size() > kMostJsonBytes) return fail(ErrorCode::limit, into.path + ": more than 32 MiB of JSON");
        return of_file(into.path, detail::read_json_cameras(text, into));
    }
    if (begin == '#' || (begin >= '0' && begin <= '9')) return read_colmap(text, into);
    return fail(ErrorCode::bad_input,
                into.path + ": no file of cameras: expected JSON of cameras, transforms.json, COLMAP's images.txt, or a glTF file");
}

/// load: limits and threads.
Result<CameraFile> read_camera_file(const std::string& path, const LoadOptions& load) {
    CameraFile file;
    file.path = is_folder(path) ? path_in(path, "images.txt") : path;
    const auto bytes = io::read_file(file.path);
    if (!bytes) return tl::unexpected(bytes.error());
    if (const auto read = read_cameras(*bytes, load, file); !read) return tl::unexpected(read.error());
    if (file.cameras.empty()) return fail(ErrorCode::bad_input, file.path + ": has no camera");
    return file;
}

/// Names for the cameras' pictures: the names without folder and extension, with other characters than letters, digits, "-", "_" and "."
/// replaced by "_". Each is used once: of equal ones, and of names of nothing else, all but the first get the camera's index.
std::vector<std::string> picture_names(const CameraFile& file) {
    constexpr std::size_t kMostCharacters = 100;
    std::set<std::string> used;
    std::vector<std::string> names;
    for (const GivenCamera& camera : file.cameras) {
        std::string name = stem_of(camera.name).substr(0, kMostCharacters);
        for (char& c : name) {
            const char small = io::lower(c);
            if (!((small >= 'a' && small <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.')) c = '_';
        }
        name.erase(0, name.find_first_not_of('.'));  // no hidden file, and no other folder
        const std::string index = std::to_string(names.size());
        if (name.empty()) name = "camera_" + index;
        while (!used.insert(name).second) name += "_" + index;
        names.push_back(std::move(name));
    }
    return names;
}

}  // namespace

namespace detail {

Result<PictureSize> checked_size(double width, double height) {
    constexpr double kMostSide = 1 << 24;
    const auto side = [](double x) { return x >= 1 && x <= kMostSide && x == static_cast<double>(static_cast<int>(x)); };
    if (!side(width) || !side(height)) return fail(ErrorCode::bad_input, "expected a width and a height in whole pixels, from 1 on");
    if (width * height > static_cast<double>(kMaxImagePixels)) return fail(ErrorCode::limit, "a picture of more than 2^28 pixels");
    return PictureSize{static_cast<int>(width), static_cast<int>(height)};
}

}  // namespace detail

Result<void> settle_cameras(RenderOptions& o) {
    if (o.camera_file.empty()) {
        if (o.camera == kAllCameras)
            return fail(ErrorCode::usage, "--camera all: expected together with --camera-file, which may be the model");
        return {};
    }
    if (o.own_view())
        return fail(ErrorCode::usage,
                    "--camera-file: cannot be combined with --camera frame, --camera-position, --camera-orbit, --view, --fit, --ortho, "
                    "--azimuth, --elevation, --zoom or --fov");
    if (o.cameras) return {};
    auto read = read_camera_file(o.camera_file, o.timed_load());
    if (!read) return tl::unexpected(read.error());
    o.cameras = std::make_shared<const CameraFile>(std::move(*read));
    if (o.camera != kAllCameras) return {};
    for (std::string& name : picture_names(*o.cameras)) o.film.views.push_back({.name = std::move(name), .of_file = true});
    return {};
}

}  // namespace halflit::engine
