#include "apps/engine/request/values.hpp"

#include "apps/engine/request/flags.hpp"
#include "apps/io/files/text.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/srgb.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace halflit::engine {
namespace {

tl::unexpected<Error> expected(std::string_view what, std::string_view found) {
    return fail(ErrorCode::usage, fmt::format("expected {}, found '{}'", what, found));
}

template <class T>
std::optional<T> number(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);  // from_chars takes no plus
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return value;
}

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t at = text.find_first_of(separators);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

/// N values with commas between them; none where one of them is wrong. read(text, index): a value, or what is false.
template <class T, std::size_t N, class Read>
std::optional<std::array<T, N>> read_all(std::string_view text, const Read& read) {
    const auto parts = split(text, ",");
    if (parts.size() != N) return std::nullopt;
    std::array<T, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        const auto value = read(parts[i], i);
        if (!value) return std::nullopt;
        values[i] = static_cast<T>(*value);
    }
    return values;
}

float linear_from_srgb8(int code) { return static_cast<float>(shading::linear_from_srgb(static_cast<double>(code) / 255.0)); }

struct NamedColor {
    std::string_view name;
    int rgb;
};
// The CSS colours of these names.
constexpr NamedColor kNamedColors[] = {{"aqua", 0x00ffff},    {"black", 0x000000},   {"blue", 0x0000ff},   {"cyan", 0x00ffff},
                                       {"fuchsia", 0xff00ff}, {"gray", 0x808080},    {"green", 0x008000},  {"grey", 0x808080},
                                       {"lime", 0x00ff00},    {"magenta", 0xff00ff}, {"maroon", 0x800000}, {"navy", 0x000080},
                                       {"olive", 0x808000},   {"orange", 0xffa500},  {"purple", 0x800080}, {"red", 0xff0000},
                                       {"silver", 0xc0c0c0},  {"teal", 0x008080},    {"white", 0xffffff},  {"yellow", 0xffff00}};
constexpr std::string_view kColorForms = "a colour (#rgb, #rrggbb, #rrggbbaa, transparent, black, white, gray, red, green, blue, ...)";

Vec4f color_from_codes(int red, int green, int blue, int alpha) {
    return {linear_from_srgb8(red), linear_from_srgb8(green), linear_from_srgb8(blue), static_cast<float>(alpha) / 255.0f};
}

Result<Vec3f> parse_vec3(std::string_view text) {
    return parse_point(text).map([](Vec3d p) { return to_float(p); });
}

constexpr float kMax = std::numeric_limits<float>::max();
constexpr int kMostPixels = std::numeric_limits<int>::max();

/// A number within the range of float.
std::optional<double> coordinate(std::string_view text, std::size_t /*index*/ = 0) {
    const auto value = number<double>(text);
    return value && std::abs(*value) <= double{kMax} ? value : std::nullopt;
}

/// Reads half angles in degrees; the light holds radians.
Result<void> set_cone(Light& light, std::string_view text) {
    const auto parts = split(text, ",");
    const auto outer = parse_float(parts.back(), 0.01f, 90.0f);
    const auto inner = parts.size() == 2 ? parse_float(parts[0], 0.0f, 90.0f) : Result<float>(0.0f);
    if (parts.size() > 2 || !outer || !inner || *inner > *outer) return expected("cone=OUT or cone=IN,OUT with 0 <= IN <= OUT <= 90", text);
    light.inner_cone_rad = static_cast<float>(*inner * (kPi / 180.0));
    light.outer_cone_rad = static_cast<float>(*outer * (kPi / 180.0));
    return {};
}

/// `intensity` is stored apart from the colour, so that the two keys may come in either order.
Result<void> set_light_key(GivenLight& given, float& intensity, std::string_view key, std::string_view value) {
    Light& light = given.light;
    const auto [name, placed, aimed, cone] = kind_of(light.type);
    if (key == "dir" && aimed) {
        const auto direction = parse_vec3(value);
        if (!direction) return tl::unexpected(direction.error());
        if (*direction == Vec3f{0, 0, 0}) return expected("a direction that is not zero", value);
        light.direction_ws = normalize_or(*direction, {0, -1, 0});
        return {};
    }
    if (key == "pos" && placed) return assign(given.position, parse_point(value));
    if (key == "range" && placed) return assign(light.range, parse_float(value, 0.0f, kMax));
    if (key == "radius" && placed) return assign(light.source_radius, parse_float(value, 0.0f, kMax));
    if (key == "size" && placed) return assign(light.shadow_radius, parse_float(value, 0.0f, kMax));
    if (key == "size")
        return parse_float(value, 0.0f, 40.0f).map([&](double degrees) {
            light.shadow_radius = static_cast<float>(degrees * (kPi / 180.0));
        });
    if (key == "cone" && cone) return set_cone(light, value);
    if (key == "power" && cone) return assign(light.cone_power, parse_float(value, 0.0f, shading::kMaxConePower));
    if (key == "intensity") return assign(intensity, parse_float(value, 0.0f, 1e9f));
    if (key == "color") return assign(light.color_linear, parse_rgb(value));
    const std::string keys = fmt::format("{}{}{}color, intensity{}, size", placed ? "pos, " : "", aimed ? "dir, " : "",
                                         cone ? "cone, power, " : "", placed ? ", range, radius" : "");
    return expected(fmt::format("one of {}", keys), key);
}

}  // namespace

Result<std::int64_t> parse_int(std::string_view text, std::int64_t min, std::int64_t max) {
    const auto value = number<std::int64_t>(text);
    if (!value || *value < min || *value > max) return expected(fmt::format("a whole number from {} to {}", min, max), text);
    return *value;
}

Result<float> parse_float(std::string_view text, float min, float max) {
    const auto value = number<float>(text);
    if (value && std::isfinite(*value) && *value >= min && *value <= max) return *value;
    if (min == -kMax && max == kMax) return expected("a finite number", text);
    if (max == kMax) return expected(fmt::format("a number from {}", min), text);
    return expected(fmt::format("a number from {} to {}", min, max), text);
}

Result<double> parse_share(std::string_view text) {
    const bool percent = text.ends_with('%');
    const double whole = percent ? 100.0 : 1.0;
    const auto value = number<double>(text.substr(0, text.size() - (percent ? 1 : 0)));
    if (!value || !(*value >= 0.0 && *value <= whole)) return expected("a share such as 0.5% or 0.005, from 0 to 1", text);
    return *value / whole;
}

Result<double> parse_percent(std::string_view text) {
    const auto value = number<double>(text.substr(0, text.size() - (text.ends_with('%') ? 1 : 0)));
    if (!value || !(*value > 0.0 && *value < 100.0)) return expected("a number of percent above 0 and below 100, as 99.9", text);
    return *value;
}

Result<std::size_t> parse_memory(std::string_view text) {
    return parse_int(text, 32, std::int64_t{1} << 30).map([](std::int64_t n) { return static_cast<std::size_t>(n) << 20; });
}

Result<double> parse_time(std::string_view text) {
    constexpr double kMost = 1e8;
    const auto value = number<double>(text);
    if (!value || !(std::abs(*value) <= kMost)) return expected("a number of seconds from -1e8 to 1e8", text);
    return *value;
}

Result<Vec3d> parse_point(std::string_view text) {
    const auto xyz = read_all<double, 3>(text, coordinate);
    if (!xyz) return expected("3 numbers separated by commas", text);
    return Vec3d{(*xyz)[0], (*xyz)[1], (*xyz)[2]};
}

Result<GivenSection> parse_section(std::string_view text) {
    const auto wrong = [&] { return expected("AXIS=POSITION, as x=0.5, -x=0.5 or y=50%, or four numbers A,B,C,D", text); };
    GivenSection out;
    out.text = text;
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
        const auto plane = read_all<double, 4>(text, coordinate);
        if (!plane) return wrong();
        out.normal = {(*plane)[0], (*plane)[1], (*plane)[2]};
        out.offset = (*plane)[3];
        return out.normal == Vec3d{} ? wrong() : Result<GivenSection>(std::move(out));
    }
    std::string_view axis = text.substr(0, equals), place = text.substr(equals + 1);
    const double sign = axis.starts_with('-') ? -1.0 : 1.0;
    if (sign < 0.0) axis.remove_prefix(1);
    if (axis == "x" || axis == "X")
        out.normal.x = sign;
    else if (axis == "y" || axis == "Y")
        out.normal.y = sign;
    else if (axis == "z" || axis == "Z")
        out.normal.z = sign;
    else
        return wrong();
    out.is_share = place.ends_with('%');
    const auto share = out.is_share ? parse_share(place) : Result<double>(0.0);
    const auto value = out.is_share ? std::optional<double>() : coordinate(place);
    if (out.is_share ? !share : !value) return wrong();
    out.offset = out.is_share ? *share : sign * *value;
    return out;
}

Result<PictureSize> parse_size(std::string_view text) {
    const auto parts = split(text, "x,");
    const auto side = [](std::string_view part) { return parse_int(part, 1, kMostPixels); };
    const auto width = side(parts.front()), height = side(parts.back());
    if (parts.size() > 2 || !width || !height)
        return expected("WIDTHxHEIGHT or the side of a square, in pixels from 1, as in 1280x720 or 256", text);
    return PictureSize{static_cast<int>(*width), static_cast<int>(*height)};
}

Result<PixelPlace> parse_pixel(std::string_view text) {
    const auto xy = read_all<int, 2>(text, [](std::string_view part, std::size_t) { return parse_int(part, 0, kMostPixels); });
    if (!xy) return expected("a pixel X,Y from the upper left corner, as in 32,24", text);
    return PixelPlace{(*xy)[0], (*xy)[1]};
}

Result<Region> parse_region(std::string_view text) {
    const auto sides =
        read_all<int, 4>(text, [](std::string_view part, std::size_t i) { return parse_int(part, i < 2 ? 0 : 1, kMostPixels); });
    if (!sides) return expected("X,Y,WIDTH,HEIGHT in pixels from the upper left corner, as in 0,0,64,64", text);
    return Region{(*sides)[0], (*sides)[1], (*sides)[2], (*sides)[3]};
}

Result<Vec4f> parse_color(std::string_view text) {
    if (text == "transparent") return Vec4f{0, 0, 0, 0};
    for (const NamedColor& named : kNamedColors)
        if (io::same_word(text, named.name)) return color_from_codes(named.rgb >> 16, (named.rgb >> 8) & 255, named.rgb & 255, 255);
    if (!text.starts_with('#')) return expected(kColorForms, text);
    const std::string_view digits = text.substr(1);
    std::uint32_t bits = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
    if (error != std::errc() || end != digits.data() + digits.size()) return expected(kColorForms, text);
    const auto nibble = [&](int shift) { return static_cast<int>((bits >> shift) & 15) * 17; };
    const auto byte = [&](int shift) { return static_cast<int>((bits >> shift) & 255); };
    switch (digits.size()) {
        case 3:
            return color_from_codes(nibble(8), nibble(4), nibble(0), 255);
        case 4:
            return color_from_codes(nibble(12), nibble(8), nibble(4), nibble(0));
        case 6:
            return color_from_codes(byte(16), byte(8), byte(0), 255);
        case 8:
            return color_from_codes(byte(24), byte(16), byte(8), byte(0));
        default:
            return expected(kColorForms, text);
    }
}

Result<Vec3f> parse_rgb(std::string_view text) {
    return parse_color(text).map([](Vec4f c) { return Vec3f{c.x, c.y, c.z}; });
}

Result<GivenLight> parse_light(std::string_view text) {
    const auto parts = split(text, ":;");
    GivenLight given;
    Light& light = given.light;
    const auto type = light_type_of(parts[0]);
    if (!type) return expected("directional, point or spot, as in directional:dir=-1,-2,-1:color=#fff:intensity=1", parts[0]);
    light.type = *type;
    float intensity = 1.0f;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        if (equals == std::string_view::npos) return expected("key=value", parts[i]);
        const auto set = set_light_key(given, intensity, parts[i].substr(0, equals), parts[i].substr(equals + 1));
        if (!set) return tl::unexpected(set.error());
    }
    light.color_linear = light.color_linear * intensity;
    light.position_ws = to_float(given.position);
    return given;
}

}  // namespace halflit::engine
