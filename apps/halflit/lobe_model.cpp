#include "apps/halflit/lobe_model.hpp"

#include "apps/halflit/messages.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace halflit::cli {
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

}  // namespace

Result<double> parse_wrap(const std::string& text) {
    auto value = parse_double(text, "a number from 0 to 1");
    if (value && *value < 0) return fail(ErrorCode::usage, fmt::format("expected a number from 0 to 1, found '{}'", printable(text)));
    if (value && *value > 1)
        return fail(ErrorCode::usage,
                    fmt::format("expected a number from 0 to 1, found '{}': from 1 on light reaches everything, and the norm is another",
                                printable(text)));
    if (value && *value == 0) value = 0.0;  // no -0
    return value;
}

Result<double> parse_power(const std::string& text) {
    auto value = parse_double(text, "a number from 0 to 10000");
    if (value && *value < 0)
        return fail(ErrorCode::usage,
                    fmt::format("expected a number from 0 to 10000, found '{}': below 0 the lobe grows without bound at its boundary",
                                printable(text)));
    if (value && *value > 10000)
        return fail(ErrorCode::usage, fmt::format("expected a number from 0 to 10000, found '{}'", printable(text)));
    if (value && *value == 0) value = 0.0;
    return value;
}

Result<LobeModel> make_lobe_model(const LobeModelOptions& options) {
    const double wrap = options.wrap.value_or(0.5);
    struct Named {
        std::string_view name;
        double wrap, power;
        bool normalize;
    };
    const Named models[] = {{"lambert", 0.0, 1.0, false}, {"green", wrap, 1.0, false},        {"half-lambert", 1.0, 1.0, false},
                            {"valve", 1.0, 2.0, false},   {"sloan", wrap, 1.0 + wrap, false}, {"mcauley", wrap, 1.0 + wrap, true}};
    for (const Named& model : models) {
        if (model.name != options.name) continue;
        const double w = options.wrap.value_or(model.wrap), n = options.power.value_or(model.power);
        const double scale = options.normalize.value_or(model.normalize) ? sh::normalizing_scale(w, n) : 1.0;
        return LobeModel{options.name, {w, n, scale}};
    }
    return fail(ErrorCode::usage,
                fmt::format("MODEL: expected lambert, green, half-lambert, valve, sloan or mcauley, found '{}'", printable(options.name)));
}

}  // namespace halflit::cli
