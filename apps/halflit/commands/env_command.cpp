// halflit env: an environment's bands of spherical harmonics, its suns, and the number of bands that it needs.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/file_flags.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "halflit/image.hpp"
#include "sh/order.hpp"
#include "sh/sun.hpp"
#include "shading/environment.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace halflit::cli {
namespace {

struct EnvOptions {
    std::string name;
    int bands = sh::kMaxBands;
    bool json = false;
    double timeout_s = 0.0;  ///< 0: none
};

/// An environment and everything that is computed from it.
struct Description {
    EnvironmentImage environment;
    sh::Projection whole;
    sh::SunExtraction extraction;
    sh::LobeSpectrum lambert = sh::lobe_spectrum({0.0, 1.0, 1.0});
    Vec3d mean;
    float max = 0;
};

Description look_at(EnvironmentImage environment) {
    sh::Projection whole(shading::view_of(environment));
    sh::SunExtraction extraction = sh::extract_suns(shading::view_of(environment), whole);
    Description out;
    out.mean = whole.mean();
    out.max = *std::max_element(environment.rgb.begin(), environment.rgb.end());
    out.environment = std::move(environment);
    out.whole = std::move(whole);
    out.extraction = std::move(extraction);
    return out;
}

Json triple(Vec3d v) { return {v.x, v.y, v.z}; }

/// Adds coefficients, band norms and bounds of one projection.
void add_projection(Json& json, const sh::Projection& projection, const sh::LobeSpectrum& lambert, int bands) {
    const sh::RadianceSh radiance = projection.radiance(bands);
    const sh::Spectrum spectrum = projection.spectrum();
    Json norms = Json::array(), coefficients = Json::array(), bounds = Json::array();
    for (std::size_t l = 0; l < static_cast<std::size_t>(bands); ++l) norms.push_back(triple(spectrum.norm[l]));
    for (std::size_t i = 0; i < static_cast<std::size_t>(sh::coefficient_count(bands)); ++i) coefficients.push_back(triple(radiance.c[i]));
    for (const Vec3d& bound : sh::BandGrid(projection).order_bounds(lambert).by_order) bounds.push_back(sh::largest(bound));
    json["band_norms"] = std::move(norms);
    json["coefficients"] = std::move(coefficients);
    json["bound_lobe"] = "lambert";
    json["bound_by_order"] = std::move(bounds);
}

Json json_of(const Description& d, int bands) {
    Json json = report_head("env");
    json["width"] = d.environment.width;
    json["height"] = d.environment.height;
    json["mean_radiance"] = triple(d.mean);
    json["max"] = d.max;
    add_projection(json, d.whole, d.lambert, bands);
    json["suns"] = Json::array();
    for (const sh::Sun& sun : d.extraction.suns)
        json["suns"].push_back({{"direction", triple(sun.direction)},
                                {"irradiance", triple(sun.irradiance)},
                                {"solid_angle", sun.solid_angle},
                                {"spread_rad", sun.spread_rad}});
    Json rest;
    rest["mean_radiance"] = triple(d.extraction.residual.mean());
    add_projection(rest, d.extraction.residual, d.lambert, bands);
    rest["sun_bound"] = sh::largest(sh::sun_bound(d.extraction.suns, d.lambert));
    json["without_suns"] = std::move(rest);
    return json;
}

/// Text picture of the expansion's luminance, laid out like the image. Each character of the ramp is twice as bright as the one before; '@'
/// is the brightest.
std::string picture(const sh::RadianceSh& radiance) {
    constexpr int kColumns = 64, kRows = 16;
    constexpr std::string_view kRamp = " .:-=+*#%@";
    std::vector<double> values;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            values.push_back(sh::luminance(sh::evaluate(radiance, sh::equirect_direction((column + 0.5) / kColumns, (row + 0.5) / kRows))));
    const double brightest = *std::max_element(values.begin(), values.end());
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double steps = values[i] > 0 ? std::log2(values[i] / brightest) : -100.0;
        const auto level = static_cast<std::size_t>(std::clamp(9.0 + std::round(steps), 0.0, 9.0));
        text += i % kColumns == 0 ? "  |" : "";
        text += kRamp[level];
        text += i % kColumns == kColumns - 1 ? "|\n" : "";
    }
    return text;
}

std::string text_of(const Description& d, int bands) {
    const sh::Spectrum spectrum = d.whole.spectrum();
    const sh::OrderBounds bounds = sh::BandGrid(d.whole).order_bounds(d.lambert);
    const sh::OrderBounds rest = sh::BandGrid(d.extraction.residual).order_bounds(d.lambert);
    std::string text = fmt::format("{} x {}, mean radiance {:.4g} {:.4g} {:.4g}, max {:.4g}\n\n", d.environment.width, d.environment.height,
                                   d.mean.x, d.mean.y, d.mean.z, d.max);
    text +=
        "Norms |L_l| of the bands, and a bound on the error of a Lambert surface lit by bands 0 to order - 1:\n"
        "band   |L_l| r          g          b   order  error below";
    text += d.extraction.suns.empty() ? "\n" : "               with suns as lights\n";
    for (std::size_t l = 0; l < static_cast<std::size_t>(bands); ++l) {
        const Vec3d& norm = spectrum.norm[l];
        text += fmt::format("{:4} {:10.4g} {:10.4g} {:10.4g}   {:5}  {:<10.4g}", l, norm.x, norm.y, norm.z, l + 1,
                            sh::largest(bounds.by_order[l]));
        text += d.extraction.suns.empty() ? "\n" : fmt::format("                {:.4g}\n", sh::largest(rest.by_order[l]));
    }
    for (const sh::Sun& sun : d.extraction.suns)
        text += fmt::format("\nsun towards {:.4f} {:.4f} {:.4f}, irradiance {:.4g} {:.4g} {:.4g}, {:.3g} sr", sun.direction.x,
                            sun.direction.y, sun.direction.z, sun.irradiance.x, sun.irradiance.y, sun.irradiance.z, sun.solid_angle);
    if (!d.extraction.suns.empty()) text += "\n";
    text += fmt::format("\nPicture of {} bands{}; each character is twice as bright as the one before:\n", bands,
                        d.extraction.suns.empty() ? "" : " without suns");
    return text + picture(d.extraction.residual.radiance(bands));
}

Result<int> describe(const EnvOptions& options) {
    auto environment = find_environment(options.name);
    if (!environment) return tl::unexpected(environment.error());
    const Description description = look_at(std::move(*environment));
    const std::string text = options.json ? to_text(json_of(description, options.bands)) : text_of(description, options.bands);
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return 0;
}

Result<int> run_env(const EnvOptions& options) {
    return within_time(options.timeout_s, [&] { return describe(options); });
}

}  // namespace

Command env_command() {
    const auto options = std::make_shared<EnvOptions>();
    EnvOptions& o = *options;
    return {"env",
            "Describe an environment: its bands of spherical harmonics, its suns, and how many bands it needs",
            {{.name = "ENVIRONMENT",
              .help = "A picture of floats (.hdr .exr .pfm), or sky or studio for the built-in ones",
              .read = read_text(o.name),
              .required = true,
              .form = "FILE|sky|studio"}},
            {{"Flags",
              {{"--bands", "N", "Number of bands to list, 1 to 10 (default 10)", read_int(o.bands, 1, sh::kMaxBands)},
               {"--json", "", "Print one JSON object", set_to(o.json)},
               timeout_flag(o.timeout_s, "Stop with exit code 5 if the description takes longer")}}},
            [options] { return run_env(*options); }};
}

}  // namespace halflit::cli
