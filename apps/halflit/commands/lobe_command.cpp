// halflit lobe: a diffuse lobe's curve, its bands (coefficients in spherical harmonics), and the error of its series of N bands.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/lobe_model.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "sh/lobe_error.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>
#include <vector>

namespace halflit::cli {
namespace {

constexpr int kSamples = 201;  ///< samples of the cosine from -1 to 1

struct LobeOptions {
    LobeModelOptions model;
    bool json = false;
};

double sample_cosine(int i) {
    constexpr int kMiddle = kSamples / 2;
    return (i - kMiddle) / static_cast<double>(kMiddle);
}

Json describe(const LobeModel& model) {
    const sh::WrapLobe& lobe = model.lobe;
    const double slope = sh::slope_at_boundary(lobe);
    Json json = report_head("lobe");
    json["model"] = model.name;
    json["wrap"] = lobe.wrap;
    json["power"] = lobe.power;
    json["scale"] = lobe.scale;
    json["boundary_cos"] = lobe.wrap == 0.0 ? 0.0 : -lobe.wrap;
    json["boundary_deg"] = std::acos(-lobe.wrap) * 180.0 / kPi;
    json["normalization"] = sh::normalizing_scale(lobe.wrap, lobe.power);
    json["slope_at_boundary"] = std::isfinite(slope) ? Json(slope) : Json(nullptr);
    json["bands"] = sh::zonal_bands(lobe);
    json["samples"] = Json::array();
    for (int i = 0; i < kSamples; ++i)
        json["samples"].push_back({{"cos", sample_cosine(i)}, {"f", sh::lobe_value(lobe, sample_cosine(i))}});
    json["orders"] = Json::array();
    for (int order = 1; order <= sh::kMaxBands; ++order) {
        const sh::TruncationError error = sh::truncation_error(lobe, order);
        json["orders"].push_back({{"order", order}, {"l2", error.l2}, {"sup", error.sup}, {"min", error.min}});
    }
    return json;
}

/// Text plot of the curve over the cosine, 61 columns by 12 rows.
std::string curve(const sh::WrapLobe& lobe) {
    constexpr int kColumns = 61, kRows = 12, kMiddle = kColumns / 2;
    std::vector<std::string> rows(kRows, std::string(kColumns, ' '));
    for (int column = 0; column < kColumns; ++column) {
        const double x = (column - kMiddle) / static_cast<double>(kMiddle);
        const double height = lobe.scale > 0 ? sh::lobe_value(lobe, x) / lobe.scale * (kRows - 1) : 0.0;
        rows[static_cast<std::size_t>(kRows - 1 - std::lround(height))][static_cast<std::size_t>(column)] = '*';
    }
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string label = i == 0 ? fmt::format("{:.3g}", lobe.scale) : i + 1 == rows.size() ? "0" : "";
        text += fmt::format("{:>8} |{}\n", label, rows[i]);
    }
    return text + fmt::format("{:>8} +{}\n{:>8}  -1{:>28}{:>31}\n", "", std::string(kColumns, '-'), "N.L", "0", "1");
}

std::string description(const LobeModel& model) {
    const sh::WrapLobe& lobe = model.lobe;
    std::string text =
        fmt::format("{}: {:.6g} * max(0, (x + {:.6g}) / {:.6g})^{:.6g}, x = N.L, the cosine between normal and light\n\n{}\n", model.name,
                    lobe.scale, lobe.wrap, 1.0 + lobe.wrap, lobe.power, curve(lobe));
    text += fmt::format("boundary       {:.4f} degrees, where the lobe ends with the slope df/dx = {:.6g}\n",
                        std::acos(-lobe.wrap) * 180.0 / kPi, sh::slope_at_boundary(lobe));
    text += fmt::format("normalization  {:.6g}, the factor that makes the mean over all light directions Lambert's\n\n",
                        sh::normalizing_scale(lobe.wrap, lobe.power));
    text +=
        "Bands f_l of the lobe, and the error of its series of bands 0 to order - 1:\n"
        "band            f_l    order      L2 error     max error  lowest value\n";
    const sh::BandFactors f = sh::zonal_bands(lobe);
    for (int l = 0; l < sh::kMaxBands; ++l) {
        const sh::TruncationError error = sh::truncation_error(lobe, l + 1);
        text += fmt::format("{:4} {:14.9f}    {:5} {:13.6g} {:13.6g} {:13.6g}\n", l, f[static_cast<std::size_t>(l)], l + 1, error.l2,
                            error.sup, error.min);
    }
    return text;
}

Result<int> run_lobe(const LobeOptions& options) {
    const auto model = make_lobe_model(options.model);
    if (!model) return tl::unexpected(model.error());
    if (model->lobe.power < 1.0)
        print_warning(fmt::format("power {}: below 1 the curve {} at its boundary", model->lobe.power,
                                  model->lobe.power == 0.0 ? "jumps" : "has an infinite slope"));
    const std::string text = options.json ? to_text(describe(*model)) : description(*model);
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command lobe_command() {
    const auto options = std::make_shared<LobeOptions>();
    LobeModelOptions& model = options->model;
    const auto normalize = [&model](bool value) -> ReadValue {
        return [&model, value](const std::string&) -> Result<void> {
            model.normalize = value;
            return {};
        };
    };
    return {"lobe",
            "Describe a diffuse lobe: its curve, its bands of spherical harmonics, and the error of a series of few bands",
            {{.name = "MODEL",
              .help = "lambert, green, half-lambert, valve, sloan or mcauley",
              .read = read_text(model.name),
              .required = true,
              .form = joined(lobe_name_list(), "|")}},
            {{"Flags",
              {{"--wrap", "W",
                "Wrap, 0 to 1: light reaches surfaces whose cosine to the light is above -W (default for green, sloan, mcauley: 0.5)",
                [&model](const std::string& text) { return assign(model.wrap, parse_wrap(text)); }},
               {"--power", "N", "Exponent, 0 to 10000 (default for sloan, mcauley: 1 + W)",
                [&model](const std::string& text) { return assign(model.power, parse_power(text)); }},
               {"--normalize", "", "Scale so that the mean over all light directions is Lambert's", normalize(true)},
               {"--no-normalize", "", "Do not scale", normalize(false)},
               {"--json", "", "Print one JSON object", set_to(options->json)}}}},
            [options] { return run_lobe(*options); }};
}

}  // namespace halflit::cli
