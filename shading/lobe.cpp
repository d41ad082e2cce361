#include "shading/lobe.hpp"

#include <charconv>

namespace halflit::shading {
namespace {

/// As short as reads back the same; never with a comma.
std::string text_of(float value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    return {digits, error == std::errc() ? end : digits};
}

}  // namespace

Result<void> check_lobe(const Lobe& lobe) {
    const auto refuse = [](const char* what, const char* range, float found, const char* why) {
        return fail(ErrorCode::bad_input,
                    std::string(what) + ": expected a number from " + range + ", found " + text_of(found) + (found == found ? why : ""));
    };
    if (!(lobe.wrap >= 0.0f)) return refuse("wrap", "0 to 1", lobe.wrap, "");
    if (!(lobe.wrap <= 1.0f)) return refuse("wrap", "0 to 1", lobe.wrap, ": from 1 on light reaches everything, and the norm is another");
    if (!(lobe.power >= 0.0f)) return refuse("power", "0 to 10000", lobe.power, ": below 0 the lobe grows without bound at its boundary");
    if (!(lobe.power <= kMaxLobePower)) return refuse("power", "0 to 10000", lobe.power, "");
    return {};
}

std::string lobe_warning(const Lobe& lobe) {
    if (!(lobe.power < 1.0f)) return {};
    return "power " + text_of(lobe.power) + ": below 1 the curve " + (lobe.power == 0.0f ? "jumps" : "has an infinite slope") +
           " at its boundary";
}

}  // namespace halflit::shading
