#include "apps/halflit/compare/compare_files.hpp"

#include "apps/halflit/report/measures_json.hpp"
#include "sh/vec3d.hpp"

#include <string_view>
#include <utility>

namespace halflit::cli {
namespace {

/// Draws each view of both, and compares them.
Result<void> compare_views(ModelPair& pair, Comparison& out) {
    SeenTriangles seen_a(pair.a.scene()), seen_b(pair.b.scene());
    Renderer renderer;
    const ShotPlanes planes{.picture = true, .depth = true, .normal = true};
    for (std::size_t i = 0; i < pair.cameras.size(); ++i) {
        const Camera& camera = pair.cameras[i];
        auto a = draw_shot(pair.a, renderer, pair.view_names[i], camera, planes);
        if (!a) return tl::unexpected(a.error());
        auto b = draw_shot(pair.b, renderer, pair.view_names[i], camera, planes);
        if (!b) return tl::unexpected(b.error());
        seen_a.add(a->instance, a->triangle), seen_b.add(b->instance, b->triangle);
        const Vec4f &eye = camera.world_from_camera.c[3], &back = camera.world_from_camera.c[2];
        const Vec3d middle = pair.bounds.empty ? Vec3d{} : to_double(pair.bounds.center());
        const double distance = dot(Vec3d{eye.x, eye.y, eye.z} - middle, Vec3d{back.x, back.y, back.z});
        out.views.push_back(compare_shots(std::move(*a), std::move(*b), out.max_codes, distance));
    }
    out.models.a.unseen_area = seen_a.unseen_area();
    out.models.b.unseen_area = seen_b.unseen_area();
    return {};
}

}  // namespace

Result<Comparison> compare_files(const CompareOptions& options) {
    auto pair = load_pair(options);
    if (!pair) return tl::unexpected(pair.error());
    Comparison out;
    out.a = options.a, out.b = options.b;
    out.unit = unit_name(pair->a.source);
    out.max_codes = options.max_codes;
    out.scale = pair->scale();
    out.warnings = pair->warnings;
    if (unit_name(pair->b.source) != out.unit) {
        out.warnings.push_back("only one of the files has a unit of length; both are compared by their numbers");
        out.unit.clear();
    }
    auto models = compare_models(*pair);
    if (!models) return tl::unexpected(models.error());
    out.models = std::move(*models);
    if (const auto compared = compare_views(*pair, out); !compared) return tl::unexpected(compared.error());
    return out;
}

std::vector<FlagGroup> compare_flags(CompareOptions& options) {
    auto groups = render_flags(options, kCompareSize);
    constexpr std::string_view kLeftOut[] = {"--region",       "--camera",  "--camera-position", "--camera-target", "--camera-file",
                                             "--camera-orbit", "--azimuth", "--elevation",       "--ortho",         "--orthographic"};
    remove_flags(groups, kLeftOut);
    groups.push_back({"Differences",
                      {{"--max", "CODES", "Largest difference of a colour's channel that is no change, 0 to 255 (default 2)",
                        read_int(options.max_codes, 0, 255)}}});
    return groups;
}

}  // namespace halflit::cli
