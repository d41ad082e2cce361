// apps/examples/wrap_shading.glsl as a GPU's driver compiles it: on Mesa's llvmpipe, against the numbers of shading/ and sh/.
//
// A picture of 32-bit floats holds the arguments, one pixel for each, and a fragment shader writes the functions' values, one row of the
// result for each function. A driver's pow is exp2(n log2 t) in float32. Its error is relative, a few units of n log2 t.
// Exit code: 0 agreed, 1 differs by more than the limit, 4 skipped (no llvmpipe here).
#include "mesa_ids.hpp"
#include "mesa_values.hpp"
#include "sh/lobe_error.hpp"
#include "shading/reference/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

using namespace halflit;
using namespace halflit::peer;
namespace reference = halflit::shading::reference;

namespace {

constexpr double kLimit = 5e-6;  // llvmpipe of Mesa 22.3: 1.4e-6, its pow at n = 20

/// Arguments of one pixel: x, w, n, and the blocker's distance as a share of the fade distance.
using Arguments = std::array<float, 4>;

std::vector<Arguments> arguments() {
    std::vector<Arguments> all;
    for (const float w : {0.0f, 0.1f, 0.25f, 0.5f, 0.75f, 1.0f})
        for (const float n : {0.0f, 0.5f, 1.0f, 1.0f + w, 2.0f, 4.0f, 20.0f})
            for (int i = -16; i <= 16; ++i)
                for (const float behind : {-0.1f, 0.4f, 0.8f, 1.1f}) all.push_back({static_cast<float>(i) / 16, w, n, behind});
    return all;
}

/// The sky's coefficients in each channel.
float sky(int index, int channel) { return index == 0 ? 6.0f : 0.5f * std::sin(static_cast<float>(3 * index + channel)); }

constexpr int kFunctions = 5;
constexpr const char* kNames[kFunctions] = {"lobes", "named lobes", "wrap_bands", "wrap_sky", "shadows"};
constexpr const char* kRows = R"(
vec4 row(int function, vec4 at, vec3 sky[9]) {
    float x = at.x;
    float w = at.y;
    float n = at.z;
    vec2 seen = shadow_tap(at.w * wrap_fade_distance(w, 2.0), wrap_fade_distance(w, 2.0), x, w);
    if (function == 0) return vec4(wrap_lobe(x, w, n), wrap_scale(w, n), mcauley_lobe(x, w, n), sloan_lobe(x, w));
    if (function == 1) return vec4(lambert(x), green_wrap(x, w), half_lambert(x), valve_lobe(x));
    if (function == 2) return vec4(wrap_bands(w, n), 0.0);
    if (function == 3) return vec4(wrap_sky(sky, vec3(0.6 * x, 0.8 * x, sqrt(1.0 - x * x)), wrap_bands(w, n)), 0.0);
    return vec4(wrap_shadowed(wrap_lobe(x, w, n), x, seen), 0.0, 0.0, 0.0);
}
)";

std::array<double, 4> expected(int function, const Arguments& at) {
    const auto [x, w, n, behind] = at;
    const auto f = [&](const Lobe& lobe) { return reference::lobe_value(lobe, double{x}); };
    const sh::BandFactors bands = sh::zonal_bands({double{w}, double{n}, 1.0});
    if (function == 0) return {f({w, n, false}), double{Lobe{w, n, true}.scale()}, f({w, n, true}), f(Lobe::sloan(w))};
    if (function == 1) return {f(Lobe::lambert()), f(Lobe::green(w)), f(Lobe::half_lambert()), f(Lobe::valve())};
    if (function == 2) return {bands[0], bands[1], bands[2], 0};
    if (function == 3) {
        sh::RadianceSh radiance{3, {}};
        for (int i = 0; i < 9; ++i) radiance.c[static_cast<std::size_t>(i)] = {double{sky(i, 0)}, double{sky(i, 1)}, double{sky(i, 2)}};
        const double cosine = double{x};
        const Vec3d light = sh::evaluate(sh::scaled_by_band(radiance, bands), {0.6 * cosine, 0.8 * cosine, std::sqrt(1 - cosine * cosine)});
        return {std::max(light.x, 0.0), std::max(light.y, 0.0), std::max(light.z, 0.0), 0};
    }
    // Soft-split of one texel, as raster/README.md states it: s = 8/9 |x| / w where x < 0, T(u) = (1 - u)^2 (1 + 2u).
    reference::Hidden hidden;
    if (behind > 0 && w > 0) {
        const double s = std::min(std::max(-double{x}, 0.0) / double{w}, 1.0) * 8 / 9;
        const double u = std::clamp((double{behind} - s) / (1 - s), 0.0, 1.0);
        hidden.hard = 1;
        hidden.soft = 1 - (1 - u) * (1 - u) * (1 + 2 * u);
    }
    return {reference::shadowed_lobe({w, n, false}, double{x}, hidden, ShadowMode::soft_split), 0, 0, 0};
}

}  // namespace

int main() {
    std::string reason;
    const std::unique_ptr<Mesa> mesa = Mesa::create(reason);
    if (!mesa) {
        std::printf("skipped: %s\n", reason.c_str());
        return 4;
    }
    std::ifstream file(HALFLIT_SOURCE_DIR "/apps/examples/wrap_shading.glsl");
    std::ostringstream listing;
    listing << file.rdbuf();
    std::vector<float> coefficients;
    for (int i = 0; i < 9; ++i)
        for (int channel = 0; channel < 3; ++channel) coefficients.push_back(sky(i, channel));
    const std::vector<Arguments> inputs = arguments();
    const auto values = shader_values(listing.str() + kRows, inputs, kFunctions, coefficients, reason);
    if (values.empty()) {
        std::printf("the listing does not run: %s\n", reason.c_str());
        return 1;
    }
    std::printf("peer: %s, %zu arguments\n", mesa->renderer().c_str(), inputs.size());
    bool good = true;
    for (int function = 0; function < kFunctions; ++function) {
        double worst = 0;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const std::array<double, 4> want = expected(function, inputs[i]);
            for (std::size_t k = 0; k < 4; ++k) {
                const double difference = std::fabs(double{values[static_cast<std::size_t>(function) * inputs.size() + i][k]} - want[k]);
                worst = std::max(worst, std::isfinite(difference) ? difference / std::max(1.0, want[k]) : HUGE_VAL);
            }
        }
        std::printf("%-12s largest difference %.2g (limit %.2g)\n", kNames[function], worst, kLimit);
        good = good && worst <= kLimit;
    }
    return good ? 0 : 1;
}
