// Changes between two models, whatever a view shows of them: measures, parts, and the distance between their surfaces.
#pragma once

#include "apps/engine/compare/hausdorff.hpp"
#include "apps/engine/compare/model_pair.hpp"
#include "halflit/measures.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

/// Measures of one model. Lengths are in the file's unit, along its axes.
struct ModelNumbers {
    Vec3d size{};
    double area = 0, volume = 0;
    std::uint64_t triangles = 0, bodies = 0, open_edges = 0, flipped_edges = 0, crowded_edges = 0;
    bool watertight = false;
    std::size_t parts = 0, instances = 0, materials = 0, textures = 0;
    std::size_t points = 0, lines = 0;  ///< drawn
    /// Share of the area whose triangles are seen in none of the views. Empty: nothing has an area.
    std::optional<double> unseen_area{};
};

enum class PartChange : std::uint8_t { added, removed, moved, geometry };
inline constexpr const char* kPartChangeNames[] = {"added", "removed", "moved", "geometry"};

struct ChangedPart {
    std::string name;  ///< may be empty
    PartChange change{};
    Vec3d shift{};  ///< of the centre of mass, for `moved` and `geometry`; file's unit
};

/// Distances in the file's unit. Points are in its coordinates.
struct SurfaceDistance {
    FarthestPoint from_a, from_b;  ///< of A's surface to B's, and of B's to A's
    [[nodiscard]] double at_least() const;
    [[nodiscard]] double at_most() const;
};

struct ModelChange {
    ModelNumbers a, b;
    std::vector<ChangedPart> parts;
    std::optional<SurfaceDistance> distance;  ///< empty: a model has no triangles, or more than kMostComparedTriangles
    bool too_many = false;                    ///< the latter
    double tolerance = 0;                     ///< a distance up to it is none: kSameShare of the diagonal of both models' box, file's unit
    [[nodiscard]] bool differs() const;
};

inline constexpr double kSameShare = 1e-6;         ///< float32 keeps positions to 6e-8 of the coordinates
inline constexpr double kDistanceAccuracy = 1e-4;  ///< of SurfaceDistance, of that diagonal
inline constexpr std::uint64_t kMostComparedTriangles = std::uint64_t{1} << 22;

/// The triangles that were seen: in a view, a triangle is what at least one pixel's first sample shows.
class SeenTriangles {
public:
    explicit SeenTriangles(const Scene& scene);
    void add(const std::vector<std::uint32_t>& instance, const std::vector<std::uint32_t>& triangle);
    /// Share of the area that was not seen. Empty: nothing has an area.
    [[nodiscard]] std::optional<double> unseen_area() const;

private:
    const Scene& scene_;
    std::vector<std::vector<bool>> seen_;  ///< of each instance
};

/// Everything but unseen_area. Fails as measure_geometry does.
[[nodiscard]] Result<ModelChange> compare_models(const ModelPair& pair);

}  // namespace halflit::engine
