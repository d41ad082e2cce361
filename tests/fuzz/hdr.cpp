// Bytes as a picture of floats (Radiance, PFM or EXR), which becomes an environment: its series of spherical harmonics, its suns, and the
// bounds of both.
#include "tests/fuzz/loading.hpp"

#include "apps/io/pictures/float_image.hpp"
#include "halflit/environment.hpp"
#include "sh/order.hpp"
#include "sh/sun.hpp"
#include "shading/environment.hpp"
#include "shading/reflection_map.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::fuzz {
namespace {

constexpr io::FloatImageLimits kLimits{256, 128, 2048};

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Numbers of one projection, as `halflit env` prints them.
void check_projection(const sh::Projection& projection, const sh::LobeSpectrum& lobe, int bands) {
    const sh::RadianceSh radiance = projection.radiance(bands);
    for (int i = 0; i < sh::coefficient_count(bands); ++i) HALFLIT_PROMISE(is_finite(radiance.c[static_cast<std::size_t>(i)]));
    const sh::Spectrum spectrum = projection.spectrum();
    for (const Vec3d& norm : spectrum.norm) HALFLIT_PROMISE(is_finite(norm));
    for (const Vec3d& bound : sh::order_bounds(spectrum, lobe).by_order) HALFLIT_PROMISE(is_finite(bound));
}

void check_environment(const EnvironmentImage& image, int bands) {
    const sh::LobeSpectrum lambert = sh::lobe_spectrum({0.0, 1.0, 1.0});
    const sh::Projection whole(shading::view_of(image));
    const sh::SunExtraction extraction = sh::extract_suns(shading::view_of(image), whole);
    for (const sh::Sun& sun : extraction.suns) {
        HALFLIT_PROMISE(is_finite(sun.direction) && is_finite(sun.irradiance));
        HALFLIT_PROMISE(std::abs(dot(sun.direction, sun.direction) - 1.0) < 1e-6);
        HALFLIT_PROMISE(sun.solid_angle > 0 && sun.solid_angle < 12.6);  // 4 pi
    }
    check_projection(whole, lambert, bands);
    check_projection(extraction.residual, lambert, bands);
}

void run(View input) {
    const auto decoded = io::decode_float_image(as_bytes(input), kLimits);
    if (!decoded) return check_error(decoded.error());
    const EnvironmentImage image{decoded->width, decoded->height, decoded->rgb, false};
    HALFLIT_PROMISE(image.rgb.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
    for (const float value : image.rgb) HALFLIT_PROMISE(value >= 0.0f && value <= 1e30f);
    check_environment(image, 1 + static_cast<int>(input.size() % sh::kMaxBands));
    const auto environment = make_environment(image, {true, static_cast<double>(input.back()), true, true});
    HALFLIT_PROMISE(environment.has_value() && std::isfinite(environment_level(**environment)));
    const shading::ReflectionMap map = shading::make_reflection_map(shading::view_of(image), shading::in_turn);
    for (const auto& rgba : map.rgba)
        for (const float value : rgba) HALFLIT_PROMISE(value >= 0.0f && value <= 1e31f);
}

/// Mostly the pixels: a header that is refused ends the run.
void mutate(Bytes& file, std::size_t max_bytes, Random& random) {
    const Bytes marker{'\n', '\n'};
    const auto blank = std::search(file.begin(), file.end(), marker.begin(), marker.end());
    const auto line = blank == file.end() ? blank : std::find(blank + 2, file.end(), '\n');
    if (line == file.end() || random.one_in(6)) return mutate_bytes(file, max_bytes);
    Bytes pixels(line + 1, file.end());
    if (pixels.size() >= 4 && random.one_in(4)) {  // a very bright or a very dark pixel
        const std::size_t at = random.below(pixels.size() / 4) * 4;
        pixels[at + 3] = static_cast<std::uint8_t>(random.next());
        for (std::size_t k = 0; k < 3; ++k) pixels[at + k] = random.one_in(2) ? 255 : static_cast<std::uint8_t>(random.next());
    } else {
        mutate_bytes(pixels, max_bytes - static_cast<std::size_t>(line + 1 - file.begin()));
    }
    file.erase(line + 1, file.end());
    file.insert(file.end(), pixels.begin(), pixels.end());
}

}  // namespace

const FuzzTarget kHdr{"hdr", 8192, run, mutate};

}  // namespace halflit::fuzz
