#include "shading/environment.hpp"

#include "sh/fp_environment.hpp"
#include "sh/sun.hpp"
#include "sh/time_limit.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/scalar.hpp"
#include "shading/out_of_memory.hpp"
#include "shading/out_of_time.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <map>
#include <new>
#include <string>

namespace halflit::shading {
namespace {

std::uint64_t next_id() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

/// `image`: without its suns. The light's direction is taken as it is, rounding included.
SunShape shape_of(const sh::EquirectView& image, const sh::Sun& sun, const Light& light, const sh::Rotation& turn, bool keep) {
    constexpr int kColumns = 1024;  // of the patches that pixels are cut into or merged to, 0.35 degrees
    const int cuts = std::max(1, kColumns / image.width), step = std::max(1, image.width / kColumns);
    const double width = static_cast<double>(image.width) * cuts, height = static_cast<double>(image.height) * cuts;
    const Vec3d direction = to_double(light.direction_ws) * -1.0, towards = direction * (1.0 / length(direction));
    Vec3d mean[3], squares{};
    SunShape shape{};
    std::map<std::pair<int, int>, SunPatch> patches;
    for (std::size_t k = 0; k < sun.pixels.size(); ++k) {
        if (k % 4096 == 0) check_time();
        const int x = sun.pixels[k] % image.width, y = sun.pixels[k] / image.width;
        const Vec3d taken = to_double(sun.before[k]) - image.at(x, y);
        for (int j = y * cuts; j < (y + 1) * cuts; ++j)
            for (int i = x * cuts; i < (x + 1) * cuts; ++i) {
                const Vec3d at = turn * sh::equirect_direction((i + 0.5) / width, (j + 0.5) / height), apart = at - towards;
                const Vec3d part = taken * (sh::pixel_solid_angle(image.width * cuts, image.height * cuts, j) / kPi);
                shape.light = shape.light + part;
                squares = squares + part * dot(apart, apart);
                mean[0] = mean[0] + apart * part.x, mean[1] = mean[1] + apart * part.y, mean[2] = mean[2] + apart * part.z;
                if (!keep) continue;
                SunPatch& patch = patches[{j / step, i / step}];
                patch.light = patch.light + part;
                patch.direction = patch.direction + at * sh::luminance(part);
            }
    }
    const auto share = [](double part, double of) { return of > 0.0 ? part / of : 0.0; };
    shape.mean_square = {share(squares.x, shape.light.x), share(squares.y, shape.light.y), share(squares.z, shape.light.z)};
    shape.drift = {share(length(mean[0]), shape.light.x), share(length(mean[1]), shape.light.y), share(length(mean[2]), shape.light.z)};
    for (auto& [place, patch] : patches) shape.patches.push_back({patch.direction * (1.0 / length(patch.direction)), patch.light});
    return shape;
}

}  // namespace

Environment environment_of(EnvironmentImage image, const EnvironmentOptions& options) {
    const sh::Projection whole(view_of(image));
    const sh::Rotation turn = sh::rotation_about_y(options.rotate_rad);
    Environment environment;
    environment.id = next_id();
    if (options.keep_image) {
        environment.rgb = image.rgb;
        environment.width = image.width;
        environment.height = image.height;
    }
    const auto take = [&](std::vector<float> rgb, const sh::Projection& projection) {
        environment.light = std::make_shared<ImageLight>(image.width, image.height, std::move(rgb), projection);
        environment.radiance = sh::rotated(environment.light->radiance(), turn);
    };
    environment.rotate_rad = options.rotate_rad;
    environment.kept_light = options.keep_light;
    environment.calibrated = image.calibrated;
    if (!options.extract_suns) {
        take(std::move(image.rgb), whole);
        return environment;
    }
    sh::SunExtraction extraction = sh::extract_suns(image.width, image.height, std::move(image.rgb), whole);
    for (const sh::Sun& sun : extraction.suns) {
        const Vec3d towards = turn * sun.direction, color = sun.irradiance * (1.0 / kPi);
        Light light;
        light.type = LightType::directional;
        light.direction_ws = {static_cast<float>(-towards.x), static_cast<float>(-towards.y), static_cast<float>(-towards.z)};
        light.color_linear = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
        environment.suns.push_back(light);
        environment.sun_shapes.push_back(
            shape_of({image.width, image.height, extraction.residual_rgb}, sun, light, turn, options.keep_light));
    }
    take(std::move(extraction.residual_rgb), extraction.residual);
    return environment;
}

Environment make_environment(std::shared_ptr<const ImageLight> light, double rotate_rad) {
    Environment environment;
    environment.id = next_id();
    environment.radiance = sh::rotated(light->radiance(), sh::rotation_about_y(rotate_rad));
    environment.light = std::move(light);
    environment.rotate_rad = rotate_rad;
    return environment;
}

}  // namespace halflit::shading

namespace halflit {

Result<std::shared_ptr<const Environment>> make_environment(EnvironmentImage image, const EnvironmentOptions& options) {
    const FpEnvironment environment_of_host;
    constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 29;
    if (image.width < 1 || image.height < 1) return fail(ErrorCode::bad_input, "environment: the image has no pixels");
    const std::uint64_t pixels = static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height), expected = 3 * pixels;
    if (image.rgb.size() != expected)
        return fail(ErrorCode::bad_input, "environment: " + std::to_string(image.rgb.size()) + " values, expected " +
                                              std::to_string(expected) + " for " + std::to_string(image.width) + " x " +
                                              std::to_string(image.height) + " pixels");
    if (pixels > kMostPixels)
        return fail(ErrorCode::limit, "environment: the image has " + std::to_string(pixels) + " pixels, the limit is 2^29");
    if (!(options.rotate_rad - options.rotate_rad == 0.0)) return fail(ErrorCode::usage, "environment: the rotation is not a finite angle");
    try {
        const TimeLimit limit(options.time_limit_s);
        TimeCheck check;
        for (const float value : image.rgb) {
            check();
            if (!(value >= 0.0f && value < 3e38f))
                return fail(ErrorCode::bad_input, "environment: found a value that is negative or not finite");
        }
        return std::make_shared<Environment>(shading::environment_of(std::move(image), options));
    } catch (const OutOfTime& found) {
        return fail_out_of_time(found, "environment: ");
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory([] { return std::string("out of memory while making an environment"); });
    }
}

std::span<const Light> environment_suns(const Environment& environment) { return environment.suns; }

double environment_level(const Environment& environment) {
    const FpEnvironment environment_of_host;
    double level = 0.28209479177387814 * sh::luminance(environment.radiance.c[0]);  // times Y_0 = 1/(2 sqrt(pi)): the mean radiance
    for (const Light& sun : environment.suns) level += 0.25 * sh::luminance({sun.color_linear.x, sun.color_linear.y, sun.color_linear.z});
    return level;
}

}  // namespace halflit
