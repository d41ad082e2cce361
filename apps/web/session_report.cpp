#include "apps/web/session_report.hpp"

#include "apps/engine/basics/hash_text.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "apps/viewer/orbit_camera.hpp"
#include "halflit/version.hpp"
#include "sh/lobe_error.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halflit::web {
namespace {

template <class Range, class Text>
std::string list_of(const Range& values, const Text& text) {
    std::string list;
    for (const auto& value : values) list.append(list.empty() ? "" : ",").append(text(value));
    return "[" + list + "]";
}

/// Seven digits: what a float holds.
std::string number(double value, int digits = 7) { return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "null"; }

/// All digits of a double: far from the origin, seven do not tell the camera from its target.
std::string point(Vec3d p) { return fmt::format("[{},{},{}]", number(p.x, 17), number(p.y, 17), number(p.z, 17)); }

/// The camera as --camera-position, --camera-target and --fov give it, in the file's world, where a turn by the mouse begins. A camera made
/// for a wider picture shows its width, and more above and below. There is no flag for an orthographic one: a perspective one shows the
/// same height at the target.
std::string view_of(const engine::RenderJob& job) {
    constexpr double kFlatFovDeg = 35.0;
    const auto tangent = [](double fov_rad) { return std::tan(fov_rad / 2); };
    const Camera& camera = job.camera;
    const auto column = [&](int i) {
        const Vec4f c = camera.world_from_camera.c[i];
        return Vec3d{static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
    };
    const Vec3d back = column(2), eye = column(3), target = eye - back * viewer::OrbitCamera(camera, job.film.bounds).distance();
    const double half_height = static_cast<double>(camera.half_height), half_width = static_cast<double>(camera.half_width);
    const double made_for = camera.orthographic ? half_width / half_height : static_cast<double>(camera.aspect);
    const double wider = std::isfinite(made_for) ? std::max(1.0, made_for * job.height / job.width) : 1.0;
    const double fov_rad =
        camera.orthographic ? kFlatFovDeg * (kPi / 180.0) : 2.0 * std::atan(tangent(static_cast<double>(camera.fov_y_rad)) * wider);
    const Vec3d position = camera.orthographic ? target + back * (half_height * wider / tangent(fov_rad)) : eye;
    const double radius = job.film.bounds.empty ? 0.0 : static_cast<double>(job.film.bounds.radius());
    const auto in_file = [&](Vec3d p) { return job.source.placement.out(p); };
    return fmt::format(R"({{"position":{},"target":{},"fov":{},"radius":{},"up":"{}"}})", point(in_file(position)), point(in_file(target)),
                       number(fov_rad * (180.0 / kPi)), number((radius > 0.0 ? radius : 1.0) / job.source.placement.scale),
                       kUpAxisNames[static_cast<std::size_t>(job.source.placement.up)]);
}

/// Lobes that materials bring along, each once.
std::string own_lobes(const Scene& scene) {
    std::vector<Lobe> lobes;
    for (const Material& material : scene.materials)
        if (std::find(lobes.begin(), lobes.end(), material.lobe) == lobes.end()) lobes.push_back(material.lobe);
    return list_of(lobes, [](const Lobe& lobe) {
        return fmt::format(R"({{"wrap":{},"power":{},"normalize":{}}})", number(static_cast<double>(lobe.wrap)),
                           number(static_cast<double>(lobe.power)), lobe.normalize);
    });
}

}  // namespace

std::string json_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out.append("\\").append(1, c);
        else if (static_cast<unsigned char>(c) < 0x20)
            out.append(fmt::format("\\u{:04x}", static_cast<unsigned>(c)));
        else
            out.append(1, c);
    }
    return out + "\"";
}

std::string picture_report(const engine::RenderJob& job, const RenderReport& report, const Image& picture, int loads) {
    std::vector<std::string> warnings = job.warnings;
    warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
    int bands = 0;
    for (const EnvironmentUse& use : report.environment) bands = std::max(bands, use.bands == 0 ? 64 : use.bands);  // a map
    return fmt::format(
        R"({{"width":{},"height":{},"pixel_hash":"{}","isa":"{}","loads":{},"render_ms":{:.2f},)"
        R"("shadows_ms":{:.2f},"tiles_ms":{:.2f},"triangles":{},"lights":{},"exposure":{},"bands":{},"bound":{},"samples":{},)"
        R"("view":{},"lobes":{},"animations":{},)"
        R"("choices":{},"warnings":{}}})",
        picture.width, picture.height, engine::hash_text(picture.rgba8), isa_name(report.isa), loads, report.total_ms, report.ms.shadows,
        report.ms.tiles, report.triangles_submitted, job.light.all_lights().size(), number(static_cast<double>(job.settings.exposure)),
        bands, number(report.error.codes), job.settings.samples, view_of(job), own_lobes(job.scene()),
        list_of(job.source.animations,
                [](const AnimationInfo& a) { return fmt::format(R"({{"name":{},"end":{}}})", json_text(a.name), number(a.end_s)); }),
        list_of(job.choices, json_text), list_of(warnings, json_text));
}

std::string error_report(const engine::TradeError& error, double reference_ms) {
    return fmt::format(R"({{"max":{},"mean":{},"p999":{},"reference_ms":{:.1f}}})", number(error.max), number(error.mean),
                       number(error.p999), reference_ms);
}

std::string lobe_report(const Lobe& lobe, int bands, int samples) {
    const sh::WrapLobe exact{static_cast<double>(lobe.wrap), static_cast<double>(lobe.power), static_cast<double>(lobe.scale())};
    const sh::BandFactors factors = sh::zonal_bands(exact);
    const sh::TruncationError error = sh::truncation_error(exact, bands);
    std::vector<double> cosines;
    for (int i = 0; i < samples; ++i) cosines.push_back(2.0 * i / (samples - 1) - 1.0);
    return fmt::format(R"({{"wrap":{},"power":{},"scale":{},"f":{},"series":{},"bands":{},"sup":{},"l2":{}}})", number(exact.wrap),
                       number(exact.power), number(exact.scale),
                       list_of(cosines, [&](double x) { return number(sh::lobe_value(exact, x)); }),
                       list_of(cosines, [&](double x) { return number(sh::series_value(factors, bands, x)); }),
                       list_of(factors, [](double factor) { return number(factor); }), number(error.sup), number(error.l2));
}

std::string table_report() {
    const auto lobe = [](const NamedLobe& model) {
        return fmt::format(R"({{"name":{},"takes_wrap":{},"wrap":{},"power":{},"power_per_wrap":{},"normalize":{}}})",
                           json_text(model.name), model.takes_wrap, model.wrap, model.power, model.power_per_wrap, model.normalize);
    };
    return fmt::format(R"({{"version":{},"pixel_epoch":{},"usual_wrap":{},"lobes":{},"specular":{},"shadows":{},"tonemap":{}}})",
                       json_text(version()), kPixelEpoch, kUsualWrap, list_of(kNamedLobes, lobe),
                       list_of(engine::kSpecularNames, json_text), list_of(engine::kShadowModeNames, json_text),
                       list_of(engine::kToneCurveNames, json_text));
}

}  // namespace halflit::web
