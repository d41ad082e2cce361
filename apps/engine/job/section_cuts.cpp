#include "apps/engine/job/section_cuts.hpp"

#include "apps/engine/job/job_steps.hpp"
#include "halflit/up_axis.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostSectionLines = 10;

/// The plane in the world that is drawn. bounds: of the scene before it is cut.
CutPlane drawn_plane(const GivenSection& given, const Placement& place, const Bounds& bounds) {
    const Vec3d normal = turned_upright(given.normal, place.up);
    if (!given.is_share) return {normal, (given.offset - dot(normal, place.origin)) * place.scale};
    // The share counts along the file's axis, whose ends a quarter turn may exchange.
    const Vec3d low = to_double(bounds.min), high = to_double(bounds.max), along = turned_upright(absolute(given.normal), place.up);
    const auto end = [&](bool upper) {
        const auto of = [&](double axis, double a, double b) { return axis * ((axis > 0.0) == upper ? b : a); };
        return of(along.x, low.x, high.x) + of(along.y, low.y, high.y) + of(along.z, low.z, high.z);
    };
    const double place_along = end(false) + (end(true) - end(false)) * given.offset;
    return {normal, dot(normal, along) * place_along};
}

/// Whether any of each part is drawn.
std::vector<bool> shown_parts(const RenderJob& job) {
    const Parts& parts = *job.source.parts;
    std::vector<bool> shown(parts.list().size(), false);
    for (std::size_t i = 0; i < job.scene().instances.size(); ++i)
        if (const int part = parts.of_instance(i); part >= 0 && job.scene().instances[i].visible)
            shown[static_cast<std::size_t>(part)] = true;
    return shown;
}

void tell_sections(RenderJob& job, const ContentRequest& request) {
    const SectionReport& report = job.sections;
    if (report.cuts.empty() && report.instances_cut == 0) job.warnings.push_back("--section: no plane goes through an object");
    for (std::size_t i = 0; i < report.cuts.size(); ++i) {
        if (i == kMostSectionLines) {
            job.choices.push_back(fmt::format("section: {} more in the report", report.cuts.size() - i));
            break;
        }
        const SectionCut& cut = report.cuts[i];
        const std::string& name = cut_name(job, cut);
        job.choices.push_back(fmt::format("section {}: object {}{}{}, area {:g}{}", request.sections[cut.plane].text, cut.part,
                                          name.empty() ? "" : ", ", name, file_area(job, cut), cut.closed ? "" : ", open"));
    }
    const auto count = [&](auto test) { return std::count_if(report.cuts.begin(), report.cuts.end(), test); };
    if (const auto open = count([](const SectionCut& cut) { return cut.open_ends > 0; }); open > 0)
        job.warnings.push_back(fmt::format(
            "--section: {} of {} sections are not closed, because the surface has a hole there; they have no cap, or a part of one", open,
            report.cuts.size()));
    if (const auto complex = count([](const SectionCut& cut) { return cut.too_complex; }); complex > 0)
        job.warnings.push_back(fmt::format("--section: {} sections cross themselves too often to be filled", complex));
}

}  // namespace

Result<void> cut_job(RenderJob& job, const ContentRequest& request) {
    const Bounds bounds = scene_bounds(job.scene());
    std::vector<CutPlane> planes;
    for (const GivenSection& given : request.sections) {
        const CutPlane plane = drawn_plane(given, job.source.placement, bounds);
        if (!(plane.offset - plane.offset == 0.0)) return fail(ErrorCode::usage, "--section: the plane is too far away");
        planes.push_back(plane);
    }
    SectionSettings settings;
    settings.hatch = request.hatch;
    settings.hatch_spacing = request.hatch_spacing * job.source.placement.scale;
    const std::vector<bool> before = shown_parts(job);
    auto report = cut_scene(job.scene(), planes, settings, job.source.parts->of_instances());
    if (!report) return fail(report.error().code, "--section: " + report.error().message);
    job.sections = std::move(*report);
    for (const SectionCut& cut : job.sections.cuts)
        if (cut.cap >= 0) job.source.parts->add_instance(static_cast<std::size_t>(cut.cap), cut.part);
    const std::vector<bool> after = shown_parts(job);
    for (std::size_t part = 0; part < before.size(); ++part)
        if (before[part] && !after[part]) job.removed.push_back(static_cast<int>(part));
    tell_sections(job, request);
    return {};
}

double file_area(const RenderJob& job, const SectionCut& cut) {
    const double unit = file_unit(job.source).per_drawn_unit;
    return cut.area * unit * unit;
}

const std::string& cut_name(const RenderJob& job, const SectionCut& cut) {
    return job.source.parts->list()[static_cast<std::size_t>(cut.part)].name;
}

}  // namespace halflit::engine
