#include "apps/engine/request/camera_orbit.hpp"

#include "apps/engine/request/flags.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/trig.hpp"

#include <fmt/core.h>

#include <initializer_list>
#include <vector>

namespace halflit::engine {
namespace {

struct OrbitUnit {
    std::string_view name;
    double factor;
};

/// A finite number and its unit, as the number times the unit's factor.
std::optional<double> in_unit(std::string_view word, std::initializer_list<OrbitUnit> units) {
    for (const auto& [name, factor] : units) {
        if (!word.ends_with(name)) continue;
        const auto number = io::detail::parse_real<double>(word.substr(0, word.size() - name.size()));
        if (number && *number - *number == 0.0) return *number * factor;
    }
    return std::nullopt;
}

std::optional<double> orbit_angle(std::string_view word, double usual_deg, double low, double high) {
    const auto angle = word == "auto" ? usual_deg : in_unit(word, {{"deg", 1.0}, {"rad", 180.0 / kPi}, {"", 1.0}});
    return angle && *angle >= low && *angle <= high ? angle : std::nullopt;
}

}  // namespace

Result<CameraOrbit> parse_camera_orbit(std::string_view text) {
    std::vector<std::string> words;
    for (std::string& word : words_of(text, ' '))
        if (!word.empty()) words.push_back(std::move(word));
    const auto expected = [&](const char* what) { return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'", what, text)); };
    if (words.size() != 3)
        return expected("an angle about the vertical, an angle from straight above and a distance, as '30deg 75deg 105%'");
    CameraOrbit orbit{.text = std::string(text)};
    constexpr double kMostTurn = 3600.0, kLeast = 1e-30, kMost = 1e30;
    const auto theta = orbit_angle(words[0], orbit.theta_deg, -kMostTurn, kMostTurn),
               phi = orbit_angle(words[1], orbit.phi_deg, 0.0, 180.0);
    if (!theta) return expected("an angle from -3600 to 3600 degrees first");
    if (!phi) return expected("an angle from 0 to 180 degrees as the second");
    orbit.theta_deg = *theta;
    orbit.phi_deg = *phi;
    orbit.share = words[2] == "auto" ? 1.0 : in_unit(words[2], {{"%", 0.01}});
    const auto distance = orbit.share ? orbit.share : in_unit(words[2], {{"cm", 0.01}, {"mm", 0.001}, {"m", 1.0}, {"", 1.0}});
    if (!distance || !(*distance >= kLeast && *distance <= kMost))
        return expected("a distance above 0 as the third, with m, cm, mm, % or auto");
    if (!orbit.share) orbit.distance = *distance;
    return orbit;
}

}  // namespace halflit::engine
