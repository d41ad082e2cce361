#include "apps/viewer/controls.hpp"

#include "apps/io/files/lobe_name.hpp"
#include "sh/vec3d.hpp"
#include "tests/viewer/jobs.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

using namespace halflit;
using namespace halflit::test;
using namespace halflit::viewer;

namespace {

std::vector<std::string> words(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> all;
    for (std::string word; in >> word;) all.push_back(word);
    return all;
}

}  // namespace

TEST_CASE("controls: untouched, they change neither settings nor lights", "[viewer]") {
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{},
          {"--lobe", "mcauley", "--wrap", "0.3", "--power", "2.5", "--specular", "phong"},
          {"--env", "sky", "--sh-order", "4", "--shadows", "hard", "--sky-shadows", "16", "--tonemap", "aces", "--samples", "8"},
          {"--max-error", "0.5", "--specular-normalize", "off"}}) {
        const OpenedJob opened = open_job("demo", flags);
        const Controls controls = controls_of(opened.job, opened.options);
        CHECK(settings_of(controls, opened.job.settings) == opened.job.settings);
        CHECK(lights_of(controls, opened.job.light.lights) == opened.job.light.lights);
        CHECK(as_flags(controls, controls, 1.0f).empty());
    }
}

TEST_CASE("controls: a model is the lobe that --lobe gives", "[viewer]") {
    Controls controls;
    for (int i = 0; i < static_cast<int>(std::size(kNamedLobes)); ++i) {
        choose_model(controls, i);
        if (kNamedLobes[i].takes_wrap) choose_wrap(controls, 0.25f);
        io::LobeParameters parameters;
        if (kNamedLobes[i].takes_wrap) parameters.wrap = 0.25f;
        INFO(kNamedLobes[i].name);
        CHECK(controls.lobe == io::lobe_from_name(kNamedLobes[i].name, parameters).value());
        CHECK_FALSE(controls.own_lobes);
    }
}

TEST_CASE("controls: the power follows the wrap until the user moves it", "[viewer]") {
    Controls controls;
    choose_model(controls, 4);  // sloan: n = 1 + w
    choose_wrap(controls, 0.75f);
    CHECK(controls.lobe.power == 1.75f);
    controls.lobe.power = 3.0f;
    choose_wrap(controls, 0.5f);
    CHECK(controls.lobe.power == 3.0f);
}

TEST_CASE("controls: lights are switched off, dimmed and turned", "[viewer]") {
    Light sun, lamp;
    sun.direction_ws = normalize_or({-1, -2, -1}, {0, -1, 0});
    lamp.type = LightType::point;
    lamp.position_ws = {1, 2, 3};
    const std::vector<Light> started{sun, lamp};
    Controls controls;
    controls.lights = light_controls(started);
    CHECK(controls.lights[0].azimuth_deg == Approx(45.0));
    CHECK(controls.lights[0].elevation_deg == Approx(54.7356103));
    controls.lights[0].azimuth_deg = 90;  // from +x
    controls.lights[0].elevation_deg = 0;
    controls.lights[1].intensity = 0.5f;
    std::vector<Light> lights = lights_of(controls, started);
    CHECK(length(to_double(lights[0].direction_ws) - Vec3d{-1, 0, 0}) < 1e-6);
    CHECK(lights[1].color_linear == Vec3f{0.5f, 0.5f, 0.5f});
    CHECK(lights[1].position_ws == lamp.position_ws);
    controls.lights[1].on = false;
    CHECK(lights_of(controls, started)[1].color_linear == Vec3f{});
    controls.lights.clear();  // before those of a new sky are known
    CHECK(lights_of(controls, started) == started);
}

TEST_CASE("controls: as flags, they give the same settings", "[viewer]") {
    const OpenedJob opened = open_job("demo", {});
    const Controls started = controls_of(opened.job, opened.options);
    Controls controls = started;
    choose_model(controls, 5);  // mcauley
    choose_wrap(controls, 0.3f);
    controls.specular = SpecularModel::ggx;
    controls.normalize_specular = false;
    controls.shadows = ShadowMode::hard;
    controls.sky_shadows = 16;
    controls.sh_order = 3;
    controls.tone_curve = ToneCurve::aces;
    controls.samples = 8;
    controls.max_error_codes = 0.5f;
    CHECK(open_job("demo", words(as_flags(controls, started, 1.0f))).job.settings == settings_of(controls, opened.job.settings));
}

TEST_CASE("controls: as flags, a turned sky and an exposure are those of the window", "[viewer]") {
    const OpenedJob opened = open_job("demo", {"--env", "sky", "--env-rotate", "30"});
    const Controls started = controls_of(opened.job, opened.options);
    Controls controls = started;
    controls.sky.rotate_deg += 10;
    controls.exposure_ev = 0.5f;
    std::vector<std::string> flags = words(as_flags(controls, started, opened.job.settings.exposure));
    CHECK(std::find(flags.begin(), flags.end(), "40") != flags.end());
    flags.insert(flags.end(), {"--env", "sky"});
    const OpenedJob again = open_job("demo", flags);
    CHECK(again.job.settings.exposure == Approx(settings_of(controls, opened.job.settings).exposure));
    CHECK(with_sky(opened.options, controls.sky).environment_rotate_deg == 40.0f);
    const Settings settings = settings_of(controls, opened.job.settings);
    CHECK(again.job.settings.shading.lobe == settings.shading.lobe);
}
