#include "apps/engine/job/job_steps.hpp"

#include "apps/engine/job/part_finder.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::engine {
namespace {

using Marks = std::vector<bool>;

Result<Marks> marked(const PartFinder& finder, std::size_t parts, const std::vector<std::string>& texts, const char* flag) {
    Marks marks(parts);
    for (const std::string& text : texts)
        if (const auto found = finder.mark(text, marks); !found)
            return fail(found.error().code, fmt::format("{}: {}", flag, found.error().message));
    return marks;
}

void tell_parts(RenderJob& job, const PartFlags& flags) {
    const auto count = [&](PartLook look) { return std::count(job.looks.begin(), job.looks.end(), look); };
    const auto ghosts = count(PartLook::ghost), highlighted = count(PartLook::highlight);
    std::string text =
        fmt::format("parts: {} of {} drawn", static_cast<std::ptrdiff_t>(job.looks.size()) - count(PartLook::hidden), job.looks.size());
    if (ghosts > 0) text += fmt::format(", {} of them as ghosts", ghosts);
    if (highlighted > 0) text += fmt::format(", {} highlighted", highlighted);
    job.choices.push_back(std::move(text));
    if (!flags.ghost.empty() && ghosts == 0) job.warnings.push_back("--ghost: its parts are hidden or highlighted");
    if (!flags.highlight.empty() && highlighted == 0) job.warnings.push_back("--highlight: its parts are hidden");
}

}  // namespace

Result<void> choose_parts(RenderJob& job, const PartFlags& flags) {
    if (!flags.any()) return {};
    const Parts& parts = *job.source.parts;
    const std::size_t count = parts.list().size();
    const PartFinder finder(parts);
    const auto only = marked(finder, count, flags.only, "--only"), hide = marked(finder, count, flags.hide, "--hide"),
               ghost = marked(finder, count, flags.ghost, "--ghost"), highlight = marked(finder, count, flags.highlight, "--highlight");
    for (const auto* marks : {&only, &hide, &ghost, &highlight})
        if (!*marks) return tl::unexpected(marks->error());
    job.looks.assign(count, flags.highlight.empty() ? PartLook::usual : PartLook::dimmed);
    for (std::size_t i = 0; i < count; ++i) {
        PartLook& look = job.looks[i];
        if ((!flags.only.empty() && !(*only)[i]) || (*hide)[i])
            look = PartLook::hidden;
        else if ((*highlight)[i])
            look = PartLook::highlight;
        else if ((*ghost)[i])
            look = PartLook::ghost;
        if (look != PartLook::hidden) continue;
        for (const int instance : parts.list()[i].instances) job.scene().instances[static_cast<std::size_t>(instance)].visible = false;
    }
    if (std::count(job.looks.begin(), job.looks.end(), PartLook::hidden) == static_cast<std::ptrdiff_t>(count))
        return fail(ErrorCode::usage,
                    fmt::format("{}: none of the scene's {} parts is left", flags.hide.empty() ? "--only" : "--hide", count));
    tell_parts(job, flags);
    return {};
}

void paint_parts(RenderJob& job, const PartFlags& flags) {
    if (flags.ghost.empty() && flags.highlight.empty()) return;
    Scene& scene = job.scene();
    if (!flags.highlight.empty())
        for (Mesh& mesh : scene.meshes) mesh.colors = {};
    std::vector<bool> is_cap(scene.instances.size());
    for (const SectionCut& cut : job.sections.cuts)
        if (cut.cap >= 0) is_cap[static_cast<std::size_t>(cut.cap)] = true;
    PartPainter painter(scene, flags.highlight_linear);
    TimeCheck check;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        check();
        const int part = job.source.parts->of_instance(i);
        const PartLook look = part < 0 ? PartLook::usual : job.looks[static_cast<std::size_t>(part)];
        if (look != PartLook::usual && look != PartLook::hidden) painter.paint(scene.instances[i], look, is_cap[i]);
    }
}

}  // namespace halflit::engine
