#include "tests/adversary/glb_writer.hpp"

#include "halflit/image.hpp"
#include "tests/support/glb_writer.hpp"

#include <cmath>
#include <cstdio>

namespace halflit::adversary {
namespace {

/// Parts of the trial that glTF and RGBE have no place for.
std::string left_out(const Trial& trial) {
    std::string text;
    for (const Light& l : trial.scene.lights) {
        if (l.type != LightType::directional && l.source_radius > 0) text += " a light's radius,";
        if (l.type == LightType::spot && l.cone_power > 0) text += " a cone's power,";
    }
    if (!(trial.scene.ambient.sky_linear == trial.scene.ambient.ground_linear)) text += " ambient light from the ground,";
    if (!trial.scene.lights.empty() && trial.scene.lights[0].shadow_radius > 0) text += " the lights' sizes,";
    if (!(trial.scene.instances[0].color == Vec4f{1, 1, 1, 1})) text += " the first instance's colour,";
    if (trial.scene.environment != nullptr) text += " more than 8 bits of the environment,";
    return text.empty() ? "" : " # not in the file:" + text.substr(0, text.size() - 1);
}

}  // namespace

Result<std::string> write_trial(const Trial& trial, const std::string& path) {
    test::GlbContent content{trial.scene, trial.camera, static_cast<double>(trial.width) / trial.height, {}, "halflit_adversary"};
    for (const auto& picture : trial.pictures) content.pictures.push_back({picture->width, picture->height, picture->rgba8});
    const auto glb = test::glb_of(content);
    if (!glb) return glb;
    if (auto ok = test::write_file(path + ".glb", glb->data(), glb->size()); !ok) return tl::unexpected<Error>(ok.error());
    const Settings& s = trial.settings;
    constexpr const char* kSpecular[] = {"none", "phong", "blinn"};
    constexpr const char* kShadows[] = {"off", "hard", "soft-split"};
    char flags[400];
    std::snprintf(flags, sizeof flags,
                  "%s.glb --size %dx%d --samples %d --background black --exposure %.9g --camera 0 --specular %s --specular-normalize %s "
                  "--shadows %s --shadow-size %d --shadow-terminator %s",
                  path.c_str(), trial.width, trial.height, s.samples, std::log2(double{s.exposure}),
                  kSpecular[static_cast<int>(s.shading.specular)], s.shading.normalize_specular ? "on" : "off",
                  kShadows[static_cast<int>(s.shadows)], s.shadow_size, s.shadow_terminator_offset ? "on" : "off");
    std::string text = flags;
    if (s.shadow_fade > 0) text += " --shadow-fade " + std::to_string(s.shadow_fade);
    if (s.sky_shadows > 0) text += " --sky-shadows " + std::to_string(s.sky_shadows);
    if (s.shading.normal_scale != 1.0f) text += " --normal-scale " + std::to_string(s.shading.normal_scale);
    if (s.shading.environment_bands > 0) text += " --sh-order " + std::to_string(s.shading.environment_bands);
    if (trial.scene.environment != nullptr) {
        Image sky{trial.sky.width, trial.sky.height, {}, {}};
        for (std::size_t i = 0; i < trial.sky.rgb.size(); i += 3)
            sky.rgba_linear.insert(sky.rgba_linear.end(), {trial.sky.rgb[i], trial.sky.rgb[i + 1], trial.sky.rgb[i + 2], 1.0f});
        const auto hdr = encode_image(sky, OutputFormat::hdr);
        if (!hdr) return tl::unexpected<Error>(hdr.error());
        if (auto ok = test::write_file(path + ".hdr", hdr->data(), hdr->size()); !ok) return tl::unexpected<Error>(ok.error());
        text += " --env " + path + ".hdr --env-sun " + (trial.sky_options.extract_suns ? "on" : "off") + " --env-rotate " +
                std::to_string(trial.sky_options.rotate_rad * 57.29577951308232);
    } else {
        const Vec3f a = trial.scene.ambient.sky_linear;
        std::snprintf(flags, sizeof flags, " --ambient %.9g,%.9g,%.9g", double{a.x}, double{a.y}, double{a.z});
        text += flags;
    }
    return text + left_out(trial);
}

}  // namespace halflit::adversary
