#include "apps/viewer/window/panels.hpp"

#include "apps/engine/request/plan_names.hpp"
#include "sh/zonal.hpp"
#include "shading/reference/reference.hpp"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <utility>

namespace halflit::viewer {
namespace {

/// A list of names, of which one is chosen.
template <class T>
bool choose(const char* label, T& value, std::span<const std::string_view> names) {
    const auto now = static_cast<std::size_t>(value);
    bool changed = false;
    if (!ImGui::BeginCombo(label, std::string(names[now]).c_str())) return false;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (ImGui::Selectable(std::string(names[i]).c_str(), i == now) && i != now) {
            value = static_cast<T>(i);
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

/// One of these numbers.
bool choose_number(const char* label, int& value, std::span<const int> numbers, const char* name_of_zero, const char* name_of_one = "1") {
    const auto name = [&](int n) { return n == 0 ? std::string(name_of_zero) : n == 1 ? std::string(name_of_one) : std::to_string(n); };
    bool changed = false;
    if (!ImGui::BeginCombo(label, name(value).c_str())) return false;
    for (const int number : numbers)
        if (ImGui::Selectable(name(number).c_str(), number == value) && number != value) {
            value = number;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

bool lobe_controls(Controls& c, bool has_own_lobes) {
    bool changed = ImGui::Checkbox("lobes of the scene", &c.own_lobes);
    if (has_own_lobes) {
        ImGui::SameLine();
        changed |= ImGui::Checkbox("over own lobes", &c.over_own_lobes);
    }
    const bool own = c.own_lobes;
    if (ImGui::BeginCombo("lobe", std::string(kNamedLobes[c.model].name).c_str())) {
        for (int i = 0; i < static_cast<int>(std::size(kNamedLobes)); ++i)
            if (ImGui::Selectable(std::string(kNamedLobes[i].name).c_str(), i == c.model)) {
                choose_model(c, i);
                changed = true;
            }
        ImGui::EndCombo();
    }
    if (float wrap = c.lobe.wrap; ImGui::SliderFloat("w (wrap)", &wrap, 0.0f, kMaxLobeWrap, "%.2f", ImGuiSliderFlags_AlwaysClamp)) {
        choose_wrap(c, wrap);
        changed = true;
    }
    const auto moved = [&](bool by_user) {
        if (by_user) c.own_lobes = false;
        changed = changed || by_user;
    };
    moved(ImGui::SliderFloat("n (power)", &c.lobe.power, 0.0f, 8.0f, "%.2f"));
    c.lobe.power = std::clamp(c.lobe.power, 0.0f, kMaxLobePower);
    moved(ImGui::Checkbox("normalize (lights and environment)", &c.lobe.normalize));
    std::array<float, 129> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(shading::reference::lobe_value(c.lobe, static_cast<double>(i) / 64.0 - 1.0));
    const std::string label = own ? "" : fmt::format("x {:.3f}", c.lobe.scale());
    ImGui::PlotLines("f(N.L), -1..1", values.data(), static_cast<int>(values.size()), 0, label.c_str(), 0.0f,
                     std::max(1.0f, *std::max_element(values.begin(), values.end())), {0, 48});
    return changed;
}

bool highlight_and_shadow_controls(Controls& c) {
    constexpr int kSkyShadows[] = {0, kSkyShadowsAuto, 16, 64, 256};
    bool changed = choose("specular", c.specular, engine::kSpecularNames);
    changed |= ImGui::Checkbox("normalize highlights", &c.normalize_specular);
    changed |= choose("shadows", c.shadows, engine::kShadowModeNames);
    changed |= choose_number("sky shadows", c.sky_shadows, kSkyShadows, "off", "auto");
    return changed;
}

bool sky_controls(Controls& c) {
    constexpr int kOrders[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    static_assert(std::size(kOrders) == sh::kMaxBands + 1);
    static constexpr std::array<std::string_view, 4> kNames{kSkyNames[0], kSkyNames[1], kSkyNames[2], kSkyNames[3]};
    bool changed = choose("sky", c.sky.sky, kNames);
    changed |= ImGui::SliderFloat("turn", &c.sky.rotate_deg, -180.0f, 180.0f, "%.0f deg");
    changed |= choose_number("SH order", c.sh_order, kOrders, "auto");
    return changed;
}

bool each_light(Controls& c) {
    constexpr std::size_t kMostShown = 64;
    bool changed = false;
    for (std::size_t i = 0; i < std::min(c.lights.size(), kMostShown); ++i) {
        LightControl& light = c.lights[i];
        ImGui::PushID(static_cast<int>(i));
        changed |= ImGui::Checkbox(fmt::format("{} {}", i, kind_of(light.type).name).c_str(), &light.on);
        changed |= ImGui::SliderFloat("intensity", &light.intensity, 0.0f, 4.0f, "%.2f");
        if (!kind_of(light.type).placed) {
            changed |= ImGui::SliderFloat("azimuth", &light.azimuth_deg, -180.0f, 180.0f, "%.0f deg");
            changed |= ImGui::SliderFloat("elevation", &light.elevation_deg, -90.0f, 90.0f, "%.0f deg");
        }
        ImGui::PopID();
    }
    if (c.lights.size() > kMostShown) ImGui::Text("and %d more", static_cast<int>(c.lights.size() - kMostShown));
    if (c.lights.empty()) ImGui::TextUnformatted("no light but the sky's");
    return changed;
}

bool picture_controls(Controls& c) {
    constexpr int kSamples[] = {1, 4, 8, 16};
    bool changed = ImGui::SliderFloat("exposure", &c.exposure_ev, -4.0f, 4.0f, "%+.2f EV");
    changed |= choose("tone curve", c.tone_curve, engine::kToneCurveNames);
    changed |= choose_number("samples", c.samples, kSamples, "");
    changed |= ImGui::SliderFloat("error budget", &c.max_error_codes, 0.0f, 4.0f, c.max_error_codes > 0.0f ? "%.2f codes" : "exact");
    return changed;
}

bool header(const char* label, bool open) {
    return ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
}

void text_tab(const char* label, const std::string& text, bool front, Tab tab, Tab& shown) {
    constexpr std::size_t kMostShown = 20000;
    if (!ImGui::BeginTabItem(label, nullptr, front ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None)) return;
    shown = tab;
    ImGui::BeginChild(label);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text.data(), text.data() + std::min(text.size(), kMostShown));
    if (text.size() > kMostShown) ImGui::TextUnformatted("... (halflit info shows all)");
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
    ImGui::EndTabItem();
}

/// A cross with an open middle.
void mark_pixel(const PanelTexts& texts) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 at{static_cast<float>(texts.mark_x) + 0.5f, static_cast<float>(texts.mark_y) + 0.5f};
    for (const auto& [color, wide] : {std::pair{IM_COL32(0, 0, 0, 255), 3.0f}, std::pair{IM_COL32(255, 220, 0, 255), 1.0f}})
        for (const auto& [x, y] : {std::pair{1.0f, 0.0f}, {-1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, -1.0f}})
            list.AddLine({at.x + 4.0f * x, at.y + 4.0f * y}, {at.x + 12.0f * x, at.y + 12.0f * y}, color, wide);
}

}  // namespace

bool Panel::draw(const PanelTexts& texts, int left, int width, int height) {
    ImGui::SetNextWindowPos({static_cast<float>(left), 0.0f});
    ImGui::SetNextWindowSize({static_cast<float>(width), static_cast<float>(height)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);  // a border's smooth edge would reach into the picture
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(texts.scene.c_str());
    ImGui::TextUnformatted(texts.status.c_str());
    if (!texts.error.empty()) ImGui::TextWrapped("error: %s", texts.error.c_str());
    reset_view = ImGui::Button("reset view");
    ImGui::SameLine();
    bool changed = ImGui::Button("reset controls");
    if (changed) {
        const bool same_sky = controls.sky == started.sky;
        std::vector<LightControl> lights = same_sky ? started.lights : std::vector<LightControl>{};
        controls = started;
        controls.lights = std::move(lights);
    }
    std::string flags = as_flags(controls, started, texts.exposure);
    if (!texts.view.empty()) flags = flags.empty() ? texts.view : texts.view + " " + flags;
    if (!flags.empty()) {
        ImGui::SameLine();
        if (ImGui::Button("copy flags")) ImGui::SetClipboardText(flags.c_str());
    }
    ImGui::BeginChild("controls", {0.0f, static_cast<float>(height) * 0.52f});
    ImGui::PushItemWidth(static_cast<float>(width) * 0.5f);
    if (header("Lobe", true)) changed |= lobe_controls(controls, has_own_lobes);
    if (header("Highlights and shadows", true)) changed |= highlight_and_shadow_controls(controls);
    if (header("Sky", true)) changed |= sky_controls(controls);
    if (header("Lights", false)) changed |= each_light(controls);
    if (header("Picture", false)) changed |= picture_controls(controls);
    ImGui::PopItemWidth();
    ImGui::EndChild();
    const bool front = select_tab;
    const Tab wanted = tab;
    select_tab = false;
    if (ImGui::BeginTabBar("texts")) {
        text_tab("Plan", texts.plan, front && wanted == Tab::plan, Tab::plan, tab);
        text_tab("Report", texts.report, front && wanted == Tab::report, Tab::report, tab);
        text_tab("Pixel", texts.pixel, front && wanted == Tab::pixel, Tab::pixel, tab);
        ImGui::EndTabBar();
    }
    ImGui::End();
    ImGui::PopStyleVar();
    if (texts.marked) mark_pixel(texts);
    return changed;
}

}  // namespace halflit::viewer
