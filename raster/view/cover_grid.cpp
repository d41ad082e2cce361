#include "raster/view/cover_grid.hpp"

#include "raster/scene/framed_part.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::raster {
namespace {

constexpr float kPiece = 1.5f;          ///< longest side of a piece, spacings
constexpr float kBroad = 0.25f;         ///< least height of a triangle that is cut into pieces like it, over its longest side
constexpr float kBehind = 0.5f;         ///< from a single-sided triangle to where it counts, spacings
constexpr float kThroughGlass = 0.75f;  ///< of the light that a surface transmits; the rest is bent aside
constexpr double kFoot = 0.02;          ///< height of the foot over that of the scene
constexpr double kBeside = 0.5;         ///< of a large ground, around what stands on it, over the longest side of that
constexpr double kLeastFoot = 0.5;      ///< the same, spacings

/// Pieces after which large triangles are cut no more: a second or so.
constexpr std::uint64_t kMostPieces = std::uint64_t{1} << 24, kBetweenLooks = std::uint64_t{1} << 18, kUnitsAPiece = 100;

/// Areas across the axes by the six directions that they face; of double-sided triangles, all of them once more.
struct Areas {
    float ahead[3], behind[3], double_sided, unused;
};

struct Triangle {
    Vec3f a, b, c;
};

class Collector {
public:
    Collector(const CoverGrid& grid, double foot_height)
        : size_{grid.size[0], grid.size[1], grid.size[2]},
          foot_(kCoverMargin + static_cast<float>(std::max(kLeastFoot, kFoot * foot_height))),
          areas(static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]) * static_cast<std::size_t>(grid.size[2])) {}

    void start(float opacity, bool mirrored, bool double_sided) {
        half_opacity_ = mirrored ? -0.5f * opacity : 0.5f * opacity;
        double_sided_ = double_sided;
    }
    void add(const Triangle& t) {
        if (pieces_ >= next_look_) {
            check_time();
            charge_work(kUnitsAPiece * kBetweenLooks);
            next_look_ = pieces_ + kBetweenLooks;
        }
        // Comparisons are false for what is not a number.
        if (!(std::min({t.a.y, t.b.y, t.c.y}) > foot_)) add_foot(t);
        const Vec3f area = cross(t.b - t.a, t.c - t.a) * half_opacity_;
        const float squared = dot(area, area);
        if (!(squared > 1e-30f && squared < 1e30f)) return;
        const Vec3f behind = double_sided_ ? Vec3f{0, 0, 0} : area * (kBehind / std::sqrt(squared));
        cut({t.a - behind, t.b - behind, t.c - behind}, area);
    }

private:
    void cut(const Triangle& t, Vec3f area) {
        const Vec3f ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
        const float of_ab = dot(ab, ab), of_bc = dot(bc, bc), of_ca = dot(ca, ca), longest = std::max({of_ab, of_bc, of_ca});
        if (!(longest > kPiece * kPiece) || pieces_ > kMostPieces) {
            add_piece((t.a + t.b + t.c) * (1.0f / 3.0f), area);
            return;
        }
        bool inside = true;
        const auto outside = [&](float a, float b, float c, int axis) {
            const float low = std::min({a, b, c}), high = std::max({a, b, c}), last = static_cast<float>(size_[axis] - 1);
            inside &= low >= 0.0f && high < last;
            return high <= 0.0f || low >= last;
        };
        if (outside(t.a.x, t.b.x, t.c.x, 0) || outside(t.a.y, t.b.y, t.c.y, 1) || outside(t.a.z, t.b.z, t.c.z, 2)) return;
        const Vec3f across = cross(ab, ca);
        if (inside && dot(across, across) > kBroad * kBroad * longest * longest) {
            add_alike(t, area, static_cast<int>(std::sqrt(longest) * (1.0f / kPiece)) + 1);
            return;
        }
        ++pieces_;
        const Vec3f half = area * 0.5f;
        if (longest == of_ab) {
            const Vec3f m = (t.a + t.b) * 0.5f;
            cut({t.a, m, t.c}, half), cut({m, t.b, t.c}, half);
        } else if (longest == of_bc) {
            const Vec3f m = (t.b + t.c) * 0.5f;
            cut({t.a, t.b, m}, half), cut({t.a, m, t.c}, half);
        } else {
            const Vec3f m = (t.c + t.a) * 0.5f;
            cut({t.a, t.b, m}, half), cut({m, t.b, t.c}, half);
        }
    }
    /// Adds a triangle as count^2 like it.
    void add_alike(const Triangle& t, Vec3f area, int count) {
        const float part = 1.0f / static_cast<float>(count);
        const Vec3f ab = (t.b - t.a) * part, ac = (t.c - t.a) * part, each = area * (part * part);
        for (int i = 0; i < count; ++i) {
            const Vec3f row = t.a + ab * static_cast<float>(i);
            for (int k = 0; i + k < count; ++k) {
                const Vec3f corner = row + ac * static_cast<float>(k), third = (ab + ac) * (1.0f / 3.0f);
                add_piece(corner + third, each);
                if (i + k + 1 < count) add_piece(corner + third * 2.0f, each);
            }
        }
    }
    void add_piece(Vec3f at, Vec3f area) {
        ++pieces_;
        const float last[3] = {static_cast<float>(size_[0] - 1), static_cast<float>(size_[1] - 1), static_cast<float>(size_[2] - 1)};
        if (!(at.x >= 0.0f && at.x < last[0] && at.y >= 0.0f && at.y < last[1] && at.z >= 0.0f && at.z < last[2])) return;
        const int x = static_cast<int>(at.x), y = static_cast<int>(at.y), z = static_cast<int>(at.z);
        const float u = at.x - static_cast<float>(x), v = at.y - static_cast<float>(y), w = at.z - static_cast<float>(z);
        const auto positive = [](float a) { return a > 0.0f ? a : 0.0f; };
        const float l1 = std::abs(area.x) + std::abs(area.y) + std::abs(area.z);
        const float part[8] = {positive(area.x),  positive(area.y),  positive(area.z),          positive(-area.x),
                               positive(-area.y), positive(-area.z), double_sided_ ? l1 : 0.0f, 0.0f};
        Areas* const first = &areas[static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x)];
        const std::ptrdiff_t row = size_[0], layer = row * size_[1];
        const auto share = [&](Areas* to, float weight) {
            float* const out = to->ahead;
            for (int k = 0; k < 8; ++k) out[k] += part[k] * weight;
        };
        const float far_w = w, near_w = 1.0f - w, near_v = 1.0f - v, near_u = 1.0f - u;
        share(first, near_u * near_v * near_w), share(first + 1, u * near_v * near_w);
        share(first + row, near_u * v * near_w), share(first + row + 1, u * v * near_w);
        Areas* const next = first + layer;
        share(next, near_u * near_v * far_w), share(next + 1, u * near_v * far_w);
        share(next + row, near_u * v * far_w), share(next + row + 1, u * v * far_w);
    }
    /// Adds the part below the foot's height.
    void add_foot(const Triangle& t) {
        const Vec3f corners[3] = {t.a, t.b, t.c};
        const auto add = [&](float x, float z) {
            // Beyond the lattice lies what views leave out.
            if (!(x >= 0.0f && z >= 0.0f && x < static_cast<float>(size_[0]) && z < static_cast<float>(size_[2]))) return;
            foot.low[0] = std::min(foot.low[0], x), foot.high[0] = std::max(foot.high[0], x);
            foot.low[1] = std::min(foot.low[1], z), foot.high[1] = std::max(foot.high[1], z);
        };
        for (int k = 0; k < 3; ++k) {
            const Vec3f &p = corners[k], &q = corners[(k + 1) % 3];
            if (p.y <= foot_) add(p.x, p.z);
            if ((p.y <= foot_) == (q.y <= foot_)) continue;
            const float part = (foot_ - p.y) / (q.y - p.y);
            add(p.x + (q.x - p.x) * part, p.z + (q.z - p.z) * part);
        }
    }

    int size_[3];
    float foot_, half_opacity_ = 0.5f;
    bool double_sided_ = false;
    std::uint64_t pieces_ = 0, next_look_ = kBetweenLooks;

public:
    std::vector<Areas> areas;
    Foot foot;
};

/// Share of the light that meets a surface which does not pass. A mask's is the mean alpha of its texture.
float opacity_of(const Scene& scene, const Material& material) {
    float opacity = 1.0f;
    if (material.alpha_mode != AlphaMode::opaque) {
        opacity = std::clamp(material.base_color.w, 0.0f, 1.0f);
        const int index = material.textures[TextureSlot::base_color].texture;
        const Texture* const texture = index >= 0 && static_cast<std::size_t>(index) < scene.textures.size()
                                           ? &scene.textures[static_cast<std::size_t>(index)]
                                           : nullptr;
        if (texture != nullptr && !texture->levels().empty())
            opacity *= static_cast<float>(texture->data()[4 * texture->levels().back().offset + 3]) * (1.0f / 65535.0f);
        else if (material.alpha_mode == AlphaMode::mask)
            opacity = material.base_color.w >= material.alpha_cutoff ? 1.0f : 0.0f;
    }
    return material.transmits() ? opacity * (1.0f - kThroughGlass * material.transmission) : opacity;
}

void collect_all(const PreparedData& prepared, const CoverGrid& grid, Collector& collector) {
    TimeCheck check;
    constexpr std::size_t kMostKept = std::size_t{1} << 18;  // vertices; more would take much memory
    const Scene& scene = prepared.scene();
    std::vector<Vec3f> places;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (!counts_for_views(scene, instance)) continue;
        const Mesh& mesh = prepared.source_mesh(instance.mesh);
        const Material& material = prepared.material(prepared.material_of(i));
        const float opacity = opacity_of(scene, material);
        if (mesh.topology != Topology::triangles || !(opacity > 0.0f)) continue;
        collector.start(opacity, determinant3(instance.world_from_object) < 0.0, material.double_sided);
        const auto place = [&](std::size_t vertex) {
            const Vec3f p = transform_point(instance.world_from_object, mesh.positions[vertex]);
            const auto along = [&](float at, int axis) { return static_cast<float>((double{at} - grid.origin[axis]) * grid.per_length); };
            return Vec3f{along(p.x, 0), along(p.y, 1), along(p.z, 2)};
        };
        const bool kept = mesh.positions.size() <= kMostKept && mesh.positions.size() < mesh.indices.size();
        places.clear();
        for (std::size_t v = 0; kept && v < mesh.positions.size(); ++v) places.push_back(place(v));
        const auto corner = [&](std::size_t k) { return kept ? places[mesh.indices[k]] : place(mesh.indices[k]); };
        for (std::size_t k = 0; k + 3 <= mesh.indices.size(); k += 3) {
            check();
            collector.add({corner(k), corner(k + 1), corner(k + 2)});
        }
    }
}

LatticeCovers rows_of(int rows, int layers) {
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(layers);
    LatticeCovers out;
    out.layout = {rows, layers, kCoverPitch, std::int64_t{kCoverPitch} * rows};
    for (std::vector<float>& part : out.parts) part.resize(count * kCoverPitch);
    out.filled.resize(count);
    return out;
}

/// What the areas hide, and where that lies in the mean.
void find_covers(const std::vector<Areas>& areas, CoverGrid& grid) {
    const int(&size)[3] = grid.size;
    LatticeCovers& along_x = grid.along_x = rows_of(size[1], size[2]);
    LatticeCovers& along_y = grid.along_y = rows_of(size[2], size[0]);
    double sum[2] = {0, 0}, all = 0;
    const Areas* from = areas.data();
    for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
            for (int x = 0; x < size[0]; ++x, ++from) {
                float total = 0.0f;
                for (int k = 0; k < 3; ++k) total += from->ahead[k] + from->behind[k];
                if (!(total > 0.0f)) continue;
                const auto by_x = static_cast<std::size_t>(z * size[1] + y), by_y = static_cast<std::size_t>(x * size[2] + z);
                const std::size_t in_x = by_x * kCoverPitch + static_cast<std::size_t>(x),
                                  in_y = by_y * kCoverPitch + static_cast<std::size_t>(y);
                const auto put = [&](std::size_t part, float value) { along_x.parts[part][in_x] = along_y.parts[part][in_y] = value; };
                for (std::size_t k = 0; k < 3; ++k) {
                    put(k, from->ahead[k] - from->behind[k]);
                    put(3 + k, std::min(from->ahead[k], from->behind[k]));
                }
                put(6, from->double_sided / total);
                along_x.filled[by_x] = along_y.filled[by_y] = 1;
                const double weight = std::min(1.0, double{total});
                sum[0] += x * weight, sum[1] += z * weight, all += weight;
            }
    if (!(all > 0.0)) {
        std::fill_n(grid.size, 3, 0);
        return;
    }
    for (const int k : {0, 1}) grid.middle[k] = sum[k] / all;
}

/// What the lattice lies around: all that views are framed by, or what stands on a large ground, and a part of that.
struct Part {
    Vec3d low, high;
    bool whole = true;
};
Part part_of(const PreparedData& prepared) {
    const FramedPart& framed = prepared.framed_part();
    const Bounds& all = prepared.framed_bounds();
    if (framed.whole) return {to_double(all.min), to_double(all.max)};
    const Vec3d low = to_double(framed.bounds.min), high = to_double(framed.bounds.max), side = high - low;
    Part part{low, high};
    const auto is_below = [](const LeftOut& one) { return one.reason == LeftOutFor::ground || one.reason == LeftOutFor::backdrop; };
    if (std::none_of(framed.left_out.begin(), framed.left_out.end(), is_below)) return part;
    const double beside = kBeside * std::max({side.x, side.y, side.z});
    const Vec3d all_low = to_double(all.min), all_high = to_double(all.max);
    part.low = {std::max(all_low.x, low.x - beside), std::max(all_low.y, low.y - beside), std::max(all_low.z, low.z - beside)};
    part.high = {std::min(all_high.x, high.x + beside), high.y, std::min(all_high.z, high.z + beside)};
    part.whole = false;
    return part;
}

CoverGrid cover_grid(const PreparedData& scene) {
    CoverGrid grid;
    if (scene.framed_bounds().empty) return grid;
    const Part part = part_of(scene);
    const Vec3d side = part.high - part.low, middle = (part.low + part.high) * 0.5;
    const double longest = std::max({side.x, side.y, side.z});
    if (!(longest > 1e-6 * length(middle) && longest > 1e-30 && longest < 1e30)) return grid;
    const double spacing = longest / (kMostCoverPoints - 1 - 2 * double{kCoverMargin});
    grid.per_length = 1.0 / spacing;
    grid.lowest = part.low.y;
    const double lows[3] = {part.low.x, part.low.y, part.low.z}, sides[3] = {side.x, side.y, side.z};
    for (int axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = lows[axis] - double{kCoverMargin} * spacing;
        grid.width[axis] = sides[axis] / spacing;
        const double points = std::ceil(grid.width[axis] - 1e-9) + 2 * double{kCoverMargin} + 1;
        grid.size[axis] = std::min(kMostCoverPoints, static_cast<int>(points));
    }
    Collector collector(grid, grid.width[1]);
    collect_all(scene, grid, collector);
    if (part.whole) grid.foot = collector.foot;
    find_covers(collector.areas, grid);
    return grid;
}

}  // namespace

void make_cover_grid(const PreparedData& scene, CoverGrid& grid) {
    SceneRevision revision = scene.revision();
    revision.lights = 0;
    if (grid.revision == revision) return;
    grid = cover_grid(scene);
    grid.revision = revision;
}

}  // namespace halflit::raster
