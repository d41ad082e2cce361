#include "halflit/lobe.hpp"

#include "sh/fp_environment.hpp"
#include "shading/lobe_range.hpp"

#include <charconv>
#include <iterator>

namespace halflit::shading {

const char* why_not_wrap(double wrap) {
    return wrap > kMaxLobeWrap ? ": above 1 every normal is lit, and the norm has another formula" : "";
}

const char* why_not_power(double power) { return power < 0 ? ": below 0 the lobe grows without bound at its boundary" : ""; }

}  // namespace halflit::shading

namespace halflit {
namespace {

/// The shortest text that reads back as the same number; never with a comma.
std::string text_of(float value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    return {digits, error == std::errc() ? end : digits};
}

}  // namespace

Result<void> check_lobe(const Lobe& lobe) {
    const FpEnvironment environment_of_host;
    const auto refuse = [](const char* what, float most, float found, const char* why) {
        return fail(ErrorCode::bad_input,
                    std::string(what) + ": expected a number from 0 to " + text_of(most) + ", found " + text_of(found) + why);
    };
    if (!(lobe.wrap >= 0.0f && lobe.wrap <= kMaxLobeWrap)) return refuse("wrap", kMaxLobeWrap, lobe.wrap, shading::why_not_wrap(lobe.wrap));
    if (!(lobe.power >= 0.0f && lobe.power <= kMaxLobePower))
        return refuse("power", kMaxLobePower, lobe.power, shading::why_not_power(lobe.power));
    return {};
}

const NamedLobe* find_named_lobe(std::string_view name) {
    for (const NamedLobe& lobe : kNamedLobes)
        if (lobe.name == name) return &lobe;
    return nullptr;
}

std::string lobe_names() {
    std::string names;
    for (std::size_t i = 0; i < std::size(kNamedLobes); ++i)
        names += std::string(i == 0 ? "" : i + 1 == std::size(kNamedLobes) ? " or " : ", ") + std::string(kNamedLobes[i].name);
    return names;
}

std::string lobe_warning(const Lobe& lobe) {
    const FpEnvironment environment_of_host;
    if (!(lobe.power < 1.0f)) return {};
    return "power " + text_of(lobe.power) + ": below 1 the curve " + (lobe.power == 0.0f ? "jumps" : "has an infinite slope") +
           " at its boundary";
}

}  // namespace halflit
