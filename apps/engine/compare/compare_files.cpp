#include "apps/engine/compare/compare_files.hpp"

#include "apps/engine/answers/measures_json.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <string_view>
#include <utility>

namespace halflit::engine {
namespace {

/// Draws views of both, and compares them.
class ViewComparer {
public:
    ViewComparer(ModelPair& pair, Comparison& out) : pair_(pair), out_(out), seen_a_(pair.a.scene()), seen_b_(pair.b.scene()) {}

    Result<ViewChange> compare(const std::string& name, const Camera& camera, bool is_kept) {
        const ShotPlanes planes{.picture = true, .depth = true, .normal = true};
        auto a = draw_shot(pair_.a, renderer_, name, camera, planes);
        if (!a) return tl::unexpected(a.error());
        auto b = draw_shot(pair_.b, renderer_, name, camera, planes);
        if (!b) return tl::unexpected(b.error());
        if (is_kept) seen_a_.add(a->instance, a->triangle), seen_b_.add(b->instance, b->triangle);
        const Mat4& m = camera.world_from_camera;
        const Vec3d middle = pair_.bounds.empty ? Vec3d{} : to_double(pair_.bounds.center());
        return compare_shots(std::move(*a), std::move(*b), out_.max_codes, dot(axis(m, 3) - middle, axis(m, 2)));
    }
    /// Adds a view to the comparison.
    Result<void> add(const std::string& name, const Camera& camera) {
        auto view = compare(name, camera, true);
        if (!view) return tl::unexpected(view.error());
        out_.views.push_back(std::move(*view));
        return {};
    }
    /// After the last view.
    void tell_unseen() {
        out_.models.a.unseen_area = seen_a_.unseen_area();
        out_.models.b.unseen_area = seen_b_.unseen_area();
    }

private:
    ModelPair& pair_;
    Comparison& out_;
    Renderer renderer_;
    SeenTriangles seen_a_, seen_b_;
};

/// Where no view shows a change that the models have, adds of other sides the one that shows most of it.
Result<void> add_side_of_change(ViewComparer& comparer, const std::vector<NamedCamera>& sides) {
    const NamedCamera* best = nullptr;
    std::uint64_t most = 0;
    for (const NamedCamera& side : sides) {
        const auto view = comparer.compare(side.name, side.camera, false);
        if (!view) return tl::unexpected(view.error());
        if (view->changed() > most) best = &side, most = view->changed();
    }
    return best != nullptr ? comparer.add(best->name, best->camera) : Result<void>();
}

Result<void> compare_views(ModelPair& pair, const CompareOptions& options, Comparison& out) {
    ViewComparer comparer(pair, out);
    for (std::size_t i = 0; i < pair.cameras.size(); ++i)
        if (const auto added = comparer.add(pair.view_names[i], pair.cameras[i]); !added) return added;
    if (out.changed_pixels() == 0 && out.models.differs() && options.film.views.empty())
        if (const auto added = add_side_of_change(comparer, other_sides(pair, options)); !added) return added;
    comparer.tell_unseen();
    return {};
}

}  // namespace

Result<Comparison> compare_files(const CompareOptions& options) {
    auto pair = load_pair(options);
    if (!pair) return tl::unexpected(pair.error());
    Comparison out;
    out.a = options.a, out.b = options.b;
    out.unit = file_unit(pair->a.source).name;
    out.max_codes = options.max_codes;
    out.scale = pair->scale();
    out.warnings = pair->warnings;
    if (file_unit(pair->b.source).name != out.unit) {
        out.warnings.push_back("only one of the files has a unit of length; both are compared by their numbers");
        out.unit.clear();
    }
    auto models = compare_models(*pair);
    if (!models) return tl::unexpected(models.error());
    out.models = std::move(*models);
    if (const auto compared = compare_views(*pair, options, out); !compared) return tl::unexpected(compared.error());
    return out;
}

std::vector<FlagGroup> compare_flags(CompareOptions& options) {
    auto groups = render_flags(options, kCompareSize);
    constexpr std::string_view kLeftOut[] = {"--region",       "--camera",  "--camera-position", "--camera-target", "--camera-file",
                                             "--camera-orbit", "--azimuth", "--elevation",       "--ortho",         "--orthographic"};
    remove_flags(groups, kLeftOut);
    tell_default(groups, "--edges", "none", "feature");
    tell_default(groups, "--shadows", "soft-split", "off");
    groups.push_back({"Differences",
                      {{"--max", "CODES", "Ignore differences up to this many 8-bit codes; 0 to 255 (default 2)",
                        read_int(options.max_codes, 0, 255)}}});
    return groups;
}

}  // namespace halflit::engine
