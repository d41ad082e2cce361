#include "apps/halflit/render_job.hpp"

#include "apps/halflit/stopwatch.hpp"
#include "apps/io/environment.hpp"
#include "apps/io/image_writer.hpp"
#include "raster/scene/exposure.hpp"
#include "raster/scene/framing.hpp"
#include "sh/trig.hpp"
#include "shading/environment.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace halflit::cli {
namespace {

Result<void> check_size(PictureSize size, const raster::Region& region) {
    if (std::int64_t{size.width} * size.height > io::kMaxImagePixels)
        return fail(ErrorCode::limit, fmt::format("--size: {}x{} is more than 2^28 pixels", size.width, size.height));
    if (std::int64_t{region.x} + region.width > size.width || std::int64_t{region.y} + region.height > size.height)
        return fail(ErrorCode::usage, fmt::format("--region: expected a part of the {}x{} picture, found {},{},{},{}", size.width,
                                                  size.height, region.x, region.y, region.width, region.height));
    return {};
}

/// The largest size with the camera's aspect ratio that fits into the usual one.
PictureSize shaped(PictureSize usual, const raster::Camera& camera) {
    double aspect = static_cast<double>(camera.aspect);
    if (camera.orthographic) aspect = camera.half_width > 0.0f ? static_cast<double>(camera.half_width / camera.half_height) : 0.0;
    if (!(aspect > 1e-3 && aspect < 1e3)) return usual;
    const double fitted = std::min(static_cast<double>(usual.width), static_cast<double>(usual.height) * aspect);
    const auto side = [](double pixels) { return std::max(1, static_cast<int>(pixels + 0.5)); };
    return {side(fitted), side(fitted / aspect)};
}

Result<const raster::Camera*> find_camera(const std::vector<raster::Camera>& cameras, const std::string& wanted) {
    for (const raster::Camera& camera : cameras)
        if (camera.name == wanted) return &camera;
    const auto index = parse_int(wanted, 0, std::int64_t{1} << 31);
    if (index && *index < static_cast<std::int64_t>(cameras.size())) return &cameras[static_cast<std::size_t>(*index)];
    if (cameras.empty()) return fail(ErrorCode::usage, fmt::format("--camera: found no camera in the scene, expected '{}'", wanted));
    return fail(ErrorCode::usage,
                fmt::format("--camera: expected an index below {} or a camera's name, found '{}'", cameras.size(), wanted));
}

/// Chooses the camera, and the size unless --size gave it. A camera of the file is used unchanged.
Result<void> choose_view(RenderJob& job, const RenderOptions& options, PictureSize usual) {
    const std::vector<raster::Camera>& cameras = job.scene().cameras;
    const raster::Camera* chosen = cameras.empty() || options.own_view ? nullptr : &cameras.front();
    if (options.camera) {
        const auto found = find_camera(cameras, *options.camera);
        if (!found) return tl::unexpected(found.error());
        chosen = *found;
    }
    const PictureSize size = options.size ? *options.size : chosen != nullptr ? shaped(usual, *chosen) : usual;
    job.width = size.width;
    job.height = size.height;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    job.camera = chosen != nullptr ? *chosen : raster::frame_scene(job.scene(), job.prepared->bounds(), aspect, options.view);
    return check_size(size, options.settings.region);
}

/// Replaces the ambient light by the environment, and adds its suns as lights. Returns the automatic exposure. A picture's unit is not
/// known, so its mean light, suns included, makes a white surface 0.5. The built-in sky has exposure 1.
Result<float> add_environment(raster::Scene& scene, const RenderOptions& options) {
    const auto image = io::environment_by_name(options.environment);
    if (!image) return tl::unexpected(image.error());
    auto environment = std::make_shared<shading::Environment>(shading::make_environment(
        image->view(), {options.environment_sun, static_cast<double>(options.environment_rotate_deg) * (kPi / 180.0),
                        options.settings.background_environment, options.settings.shading.accuracy == shading::Accuracy::reference}));
    scene.ambient = {};
    double level = 0.28209479177387814 * sh::luminance(environment->radiance.c[0]);  // times Y_0 = 1/(2 sqrt(pi)): the mean radiance
    for (const shading::Light& sun : environment->suns) {
        scene.lights.push_back(sun);
        level += 0.25 * sh::luminance({sun.color_linear.x, sun.color_linear.y, sun.color_linear.z});
    }
    scene.environment = std::move(environment);
    if (options.environment == "sky" || !(level > 1e-18 && level < 1e18)) return 1.0f;
    return static_cast<float>(0.5 / level);
}

/// Chooses lights, ambient light and exposure. The unit of a file's own lights is not known, so the exposure is chosen from them; ambient
/// light is added if the file has none. Lights from flags and built-in scenes are made for exposure 1.
Result<void> choose_light(RenderJob& job, const RenderOptions& options, const raster::Bounds& bounds) {
    raster::Scene& scene = job.scene();
    if (!options.scene_lights) {
        scene.lights.clear();
        scene.ambient = {};
    }
    if (!options.environment.empty()) {
        const auto exposure = add_environment(scene, options);
        if (!exposure) return tl::unexpected(exposure.error());
        scene.lights.insert(scene.lights.end(), options.lights.begin(), options.lights.end());
        job.settings.exposure = options.exposure.value_or(*exposure);
        return {};
    }
    const bool foreign = job.source.file && !scene.lights.empty();
    scene.lights.insert(scene.lights.end(), options.lights.begin(), options.lights.end());
    const bool ambient_alone = !options.scene_lights && options.ambient_linear;
    if (scene.lights.empty() && !ambient_alone) raster::add_default_lights(scene, job.camera);
    if (options.ambient_linear)
        scene.ambient = {*options.ambient_linear, *options.ambient_linear};
    else if (foreign && scene.ambient.sky_linear == Vec3f{} && scene.ambient.ground_linear == Vec3f{})
        scene.ambient = raster::soft_ambient(scene, bounds);
    const float automatic = foreign ? raster::auto_exposure(scene, bounds) : 1.0f;
    job.settings.exposure = options.exposure.value_or(automatic);
    return {};
}

Result<void> choose_settings(raster::Settings& settings, const RenderOptions& options) {
    settings = options.settings;
    const shading::PlanOptions& s = settings.shading;
    if (s.max_error_codes > 0.0) {
        if (s.accuracy != shading::Accuracy::exact) return fail(ErrorCode::usage, "--max-error: cannot be combined with --accuracy");
        if (s.rate != shading::ShadingRate::pixel)
            return fail(ErrorCode::usage, "--max-error: expected --shading pixel; the error of other rates has no bound");
        if (s.texture_detail != shading::TextureDetail::full)
            return fail(ErrorCode::usage, "--max-error: expected --texture-filter full; the error of other filters has no bound");
    }
    const auto lobe = chosen_lobe(options);
    if (!lobe) return tl::unexpected(lobe.error());
    if (!settings.isa) return fail(ErrorCode::usage, settings.isa.error().message);
    settings.shading.override_lobe = lobe->has_value();
    settings.shading.lobe = lobe->value_or(shading::Lobe{});
    return {};
}

}  // namespace

Result<RenderJob> make_render_job(const RenderOptions& options, PictureSize usual) {
    if (options.settings.background_environment && options.environment.empty())
        return fail(ErrorCode::usage, "--background: environment needs --env");
    if (options.camera && options.own_view)
        return fail(ErrorCode::usage,
                    "--camera: cannot be combined with --azimuth, --elevation, --zoom or --fov, which make a camera of their own");
    if (options.size)
        if (const auto checked = check_size(*options.size, options.settings.region); !checked) return tl::unexpected(checked.error());
    RenderJob job;
    if (const auto chosen = choose_settings(job.settings, options); !chosen) return tl::unexpected(chosen.error());

    const Stopwatch loading;
    auto source = load_scene(options);
    if (!source) return tl::unexpected(source.error());
    job.load_ms = loading.ms();
    job.source = std::move(*source);
    job.warnings = job.source.warnings;

    const Stopwatch preparing;
    auto prepared = raster::PreparedScene::make(job.scene(), {job.settings.threads, {}});
    if (!prepared) return tl::unexpected(prepared.error());
    job.prepared = std::move(*prepared);
    job.prepare_ms = preparing.ms();
    const raster::Bounds bounds = job.prepared->bounds();
    const bool loader_said_so = job.source.file && job.source.file->triangles_drawn == 0;
    if (bounds.empty && !loader_said_so) job.warnings.push_back("nothing to draw: no vertex has finite coordinates");
    if (const auto viewed = choose_view(job, options, usual); !viewed) return tl::unexpected(viewed.error());
    if (const auto lit = choose_light(job, options, bounds); !lit) return tl::unexpected(lit.error());
    if (const auto updated = job.prepared->update({.lights = true}); !updated) return tl::unexpected(updated.error());
    job.settings.region = options.settings.region.width > 0 ? options.settings.region : raster::Region{0, 0, job.width, job.height};
    return job;
}

raster::Image make_image(const RenderJob& job, bool linear) {
    raster::Image image{job.width, job.height, {}, {}};
    const std::size_t values = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height) * 4;
    image.rgba8.resize(values);
    if (linear) image.rgba_linear.resize(values);
    return image;
}

raster::FramebufferView view_of(raster::Image& image) {
    return {image.width, image.height, image.rgba8.data(), image.rgba_linear.empty() ? nullptr : image.rgba_linear.data()};
}

raster::Image cropped(raster::Image image, const raster::Region& region) {
    if (region.width == image.width && region.height == image.height) return image;
    raster::Image part{region.width, region.height, {}, {}};
    const auto copy_rows = [&](const auto& from, auto& to) {
        if (from.empty()) return;
        const std::ptrdiff_t stride = std::ptrdiff_t{4} * image.width, length = std::ptrdiff_t{4} * region.width;
        for (int y = 0; y < region.height; ++y) {
            const auto row = from.begin() + (region.y + y) * stride + std::ptrdiff_t{4} * region.x;
            to.insert(to.end(), row, row + length);
        }
    };
    copy_rows(image.rgba8, part.rgba8);
    copy_rows(image.rgba_linear, part.rgba_linear);
    return part;
}

}  // namespace halflit::cli
