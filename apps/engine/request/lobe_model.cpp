#include "apps/engine/request/lobe_model.hpp"

#include "apps/engine/basics/printable.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "halflit/lobe.hpp"
#include "shading/lobe_range.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace halflit::engine {
namespace {

Result<double> parse_double(std::string_view text, std::string_view expected) {
    const auto refuse = [&](std::string_view why) {
        return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'{}", expected, printable(text), why));
    };
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || digits.empty()) return refuse("");
    if (std::isnan(value)) return refuse(", which is not a number");
    return value;
}

/// A number from 0 to `most`; `why` gives the reason for refusing another one.
Result<double> parse_parameter(const std::string& text, double most, const char* (*why)(double)) {
    const std::string expected = fmt::format("a number from 0 to {:g}", most);
    const auto value = parse_double(text, expected);
    if (!value) return value;
    if (!(*value >= 0 && *value <= most))
        return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'{}", expected, printable(text), why(*value)));
    return *value == 0 ? 0.0 : *value;  // no -0
}

}  // namespace

std::vector<std::string> lobe_name_list() {
    std::vector<std::string> names;
    for (const NamedLobe& lobe : kNamedLobes) names.emplace_back(lobe.name);
    return names;
}

std::string did_you_mean_lobe(const std::string& name) {
    return find_named_lobe(name) != nullptr ? std::string() : did_you_mean(name, lobe_name_list());
}

Result<double> parse_wrap(const std::string& text) { return parse_parameter(text, kMaxLobeWrap, &shading::why_not_wrap); }

Result<double> parse_power(const std::string& text) { return parse_parameter(text, kMaxLobePower, &shading::why_not_power); }

Result<LobeModel> make_lobe_model(const LobeModelOptions& options) {
    const NamedLobe* model = find_named_lobe(options.name);
    if (model == nullptr)
        return fail(ErrorCode::usage, fmt::format("MODEL: expected {}, found '{}'{}", lobe_names(), printable(options.name),
                                                  did_you_mean_lobe(options.name)));
    const double own_wrap = model->takes_wrap ? options.wrap.value_or(double{kUsualWrap}) : double{model->wrap};
    const double own_power = double{model->power} + double{model->power_per_wrap} * own_wrap;
    const double w = options.wrap.value_or(own_wrap), n = options.power.value_or(own_power);
    const double scale = options.normalize.value_or(model->normalize) ? sh::normalizing_scale(w, n) : 1.0;
    return LobeModel{options.name, {w, n, scale}};
}

}  // namespace halflit::engine
