// Two versions of a model, loaded into one world, and cameras that show both at one scale.
#pragma once

#include "apps/engine/job/render_job.hpp"

#include <string>
#include <vector>

namespace halflit::engine {

/// Picture size of each view without --size.
inline constexpr PictureSize kCompareSize{640, 480};

struct CompareOptions : RenderOptions {
    std::string a, b;  ///< files; a built-in scene counts too
    int max_codes = 2;
    std::string folder, json, markdown;  ///< empty: none
};

/// B lies in the drawn world of A: where files are moved to the origin, both are moved alike. Lights and exposure are chosen by the box of
/// both, so a part that is added changes the light of no other.
struct ModelPair {
    RenderJob a, b;
    std::vector<std::string> view_names;
    std::vector<Camera> cameras;  ///< one for each name
    Bounds bounds;                ///< of both, in the drawn world
    std::vector<std::string> warnings;

    /// Units of the drawn world in one of the file's.
    [[nodiscard]] double scale() const { return a.source.placement.scale; }
    /// A point in A's own coordinates.
    [[nodiscard]] Vec3d out(Vec3d p) const { return a.source.placement.out(p); }
    [[nodiscard]] double diagonal() const { return 2.0 * bounds.radius(); }  ///< of the drawn world
};

/// Views are those of --view, else front, right, top and iso; by parallel rays unless --fov is given. Of the cameras, scale and distance
/// are the least that show both models whole in each view.
[[nodiscard]] Result<ModelPair> load_pair(const CompareOptions& options);

struct NamedCamera {
    std::string name;  ///< as --view takes it
    Camera camera;
};
/// Sides and corners that the usual views do not show, each framed by itself.
[[nodiscard]] std::vector<NamedCamera> other_sides(const ModelPair& pair, const CompareOptions& options);

}  // namespace halflit::engine
