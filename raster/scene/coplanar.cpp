#include "raster/scene/coplanar.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
#include "raster/scene/plane_cells.hpp"
#include "raster/scene/prepared_data.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace halflit::raster {
namespace {

/// Limits of a search.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21, kMostPairs = std::size_t{1} << 20;
constexpr std::size_t kFreeComparisons = std::size_t{1} << 20, kComparisonsAnItem = 32;

WorldBox common_part(const WorldBox& a, const WorldBox& b) {
    WorldBox both;
    for (std::size_t k = 0; k < 3; ++k) both.low[k] = std::max(a.low[k], b.low[k]), both.high[k] = std::min(a.high[k], b.high[k]);
    return both;
}

/// An instance that may meet one of another material.
struct Item {
    std::uint32_t instance, material;
    bool searched;            ///< pairs with it are asked for
    std::int32_t reach = -1;  ///< index of the box around all that it has in common with boxes of others
};

/// A triangle in world space.
struct Facet {
    CoplanarPair::Member place;
    std::uint32_t material;
    bool searched, both_sides;
    Vec3d corner[3];
    Vec3d normal;            ///< of the front, unit length
    Vec3d size;              ///< magnitude of the terms that make the corners' coordinates
    double altitude = -1.0;  ///< below 0: neither it nor the normal is known
    bool mirrored;
    WorldBox box;
};

void set_normal(Facet& facet) {
    if (facet.altitude >= 0.0) return;
    const Vec3d &a = facet.corner[0], &b = facet.corner[1], &c = facet.corner[2], normal = cross(b - a, c - a);
    const double area = length(normal), longest = std::max({length(b - a), length(c - a), length(c - b)});
    facet.altitude = longest > 0.0 ? area / longest : 0.0;
    facet.normal = normal * ((facet.mirrored ? -1.0 : 1.0) / (area > 0.0 ? area : 1.0));
}

/// True if both can be seen from one side, lie in one plane, and have more in common than rounding makes.
bool overlap(Facet& a, Facet& b) {
    if (a.material == b.material || !(a.searched || b.searched) || !a.box.meets(b.box)) return false;
    set_normal(a);
    set_normal(b);
    if (!a.both_sides && !b.both_sides && dot(a.normal, b.normal) < 0.0) return false;
    const Facet &plane = a.altitude < b.altitude ? b : a, &other = a.altitude < b.altitude ? a : b;
    const Vec3d size{std::max(a.size.x, b.size.x), std::max(a.size.y, b.size.y), std::max(a.size.z, b.size.z)};
    const double off_plane = kRounding * dot(absolute(plane.normal), size);
    for (const Vec3d& p : other.corner)
        if (absolute(dot(plane.normal, p - plane.corner[0])) > off_plane) return false;
    // They are apart if an edge of one has the other outside.
    const double slack = 4.0 * kRounding * std::max({size.x, size.y, size.z});
    const auto apart = [slack, n = plane.normal](const Facet& of, const Facet& from) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d edge = of.corner[(k + 1) % 3] - of.corner[k], inwards = cross(n, edge);
            const double side = dot(inwards, of.corner[(k + 2) % 3] - of.corner[k]) < 0.0 ? -1.0 : 1.0;
            double farthest = -1.0;
            for (const Vec3d& p : from.corner) farthest = std::max(farthest, side * dot(inwards, p - of.corner[k]));
            if (farthest <= slack * length(edge)) return true;
        }
        return false;
    };
    return !apart(a, b) && !apart(b, a);
}

/// The search. Planes fall into cells of a grid by the magnitudes of their normals' x and y and of their distance from the scene's middle.
/// A plane near a cell's border falls into both cells. Only triangles in cells with several materials are compared.
class CoplanarSearch {
public:
    CoplanarSearch(const PreparedData& scene, std::span<const std::uint8_t> among) : scene_(scene), among_(among) {}

    std::vector<CoplanarPair> pairs() {
        const std::vector<bool>& drawn = scene_.drawn_materials();
        if (std::count(drawn.begin(), drawn.end(), true) < 2 || !find_items() || !find_meetings()) return {};
        fill_cells();
        compare_cells();
        std::sort(pairs_.begin(), pairs_.end());
        pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
        return std::move(pairs_);
    }

private:
    struct Entry {
        std::uint32_t cell, item, triangle;
    };

    /// Lists instances of triangles that are seen and may meet a searched one. False: they have one material, or none is searched.
    bool find_items() {
        const std::size_t count = scene_.scene().instances.size();
        if (among_.empty()) {
            for (std::size_t i = 0; i < count; ++i) add_instance(i, nullptr);
        } else {
            for (std::size_t i = 0; i < count; ++i)
                if (among_[i] != 0) add_instance(i, nullptr);
            if (items_.empty()) return false;
            WorldBox all = box_of(items_.front());
            for (const Item& item : items_) all.include(box_of(item));
            for (std::size_t i = 0; i < count; ++i)
                if (among_[i] == 0) add_instance(i, &all);
        }
        return std::any_of(items_.begin(), items_.end(), [&](const Item& item) { return item.material != items_.front().material; });
    }

    /// near: null, or a box that it has to meet.
    void add_instance(std::size_t number, const WorldBox* near) {
        if (scene_.instance_bounds()[number].empty) return;
        if (scene_.source_mesh(scene_.scene().instances[number].mesh).topology != Topology::triangles) return;
        const Item item{static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(scene_.material_of(number)), near == nullptr};
        if (scene_.material(item.material).shadow_catcher || (near != nullptr && !near->meets(box_of(item)))) return;
        items_.push_back(item);
    }

    [[nodiscard]] WorldBox box_of(const Item& item) const {
        const Bounds& box = scene_.instance_bounds()[item.instance];
        const double slack = kRounding * largest_coordinate(box);
        return {{box.min.x - slack, box.min.y - slack, box.min.z - slack}, {box.max.x + slack, box.max.y + slack, box.max.z + slack}};
    }

    /// Finds out which instances meet one of another material. False: none do, or there is too much to look at.
    bool find_meetings() {
        struct Open {
            std::uint32_t item;
            WorldBox box;
        };
        std::vector<std::pair<float, std::uint32_t>> order;
        for (std::uint32_t i = 0; i < items_.size(); ++i) order.emplace_back(scene_.instance_bounds()[items_[i].instance].min.x, i);
        std::sort(order.begin(), order.end());
        std::vector<Open> open;
        std::size_t left = kFreeComparisons + kComparisonsAnItem * items_.size();
        const auto reach = [&](Item& item, const WorldBox& box) {
            if (item.reach >= 0) return reaches_[static_cast<std::size_t>(item.reach)].include(box);
            item.reach = static_cast<std::int32_t>(reaches_.size());
            reaches_.push_back(box);
        };
        for (const auto& [x, i] : order) {
            if (left < open.size()) return false;
            left -= open.size();
            Item& item = items_[i];
            const WorldBox box = box_of(item);
            std::erase_if(open, [&](const Open& o) { return o.box.high[0] < box.low[0]; });
            for (const Open& o : open) {
                Item& other = items_[o.item];
                if (item.material == other.material || !(item.searched || other.searched) || !box.meets(o.box)) continue;
                const WorldBox both = common_part(box, o.box);
                reach(item, both);
                reach(other, both);
            }
            open.push_back({i, box});
        }
        return !reaches_.empty();
    }

    void fill_cells() {
        std::size_t triangles = 0;
        for (const Item& item : items_)
            if (item.reach >= 0) triangles += triangle_count(scene_.source_mesh(scene_.scene().instances[item.instance].mesh));
        if (triangles > kMostTriangles) return;
        constexpr std::uint64_t kUnitsATriangle = 12;
        charge_work(kUnitsATriangle * triangles);
        WorldBox all = reaches_.front();
        for (const WorldBox& reach : reaches_) all.include(reach);
        float middle[3];
        double square = 0.0, largest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = static_cast<float>(0.5 * (all.low[k] + all.high[k]));
            const double half = 0.5 * (all.high[k] - all.low[k]);
            square += half * half;
            largest = std::max({largest, absolute(all.low[k]), absolute(all.high[k])});
        }
        const double radius = std::max(__builtin_sqrt(square), 0x1p-11 * largest);
        planes_.set_place(middle, radius > 0.0 ? static_cast<float>(1.0 / radius) : 0.0f);
        table_.begin(triangles);
        entries_.reserve(triangles + triangles / 2);
        for (std::uint32_t i = 0; i < items_.size(); ++i)
            if (items_[i].reach >= 0) add_item(i);
    }

    void add_item(std::uint32_t number) {
        const Item& item = items_[number];
        const Instance& instance = scene_.scene().instances[item.instance];
        const Mesh& mesh = scene_.source_mesh(instance.mesh);
        const PreparedMesh& prepared = scene_.mesh(instance.mesh);
        const WorldBox& reach = reaches_[static_cast<std::size_t>(item.reach)];
        for (std::size_t c = 0; c < prepared.cluster_count(); ++c) {
            const PlacedBox placed(prepared.clusters[c].min, prepared.clusters[c].max, instance.world_from_object);
            WorldBox box{};
            for (std::size_t k = 0; k < 3; ++k) box.low[k] = placed.low[k], box.high[k] = placed.high[k];
            if (!box.meets(reach)) continue;
            const auto range = triangles_of_cluster(mesh, c);
            const std::size_t begin = range.begin, count = range.end - begin;
            planes_.find(mesh, begin, count, instance.world_from_object, box, reach);
            for (std::size_t i = 0; i < count; ++i)
                planes_.each_cell(i, [&](std::uint64_t key) {
                    const std::uint32_t cell = table_.add(key, item.material);
                    if (cell != PlaneTable::kNone) entries_.push_back({cell, number, static_cast<std::uint32_t>(begin + i)});
                });
        }
    }

    void compare_cells() {
        std::erase_if(entries_, [&](const Entry& e) { return !table_.has_several(e.cell); });
        std::sort(entries_.begin(), entries_.end(), timed_less([](const Entry& a, const Entry& b) {
                      return std::tie(a.cell, a.item, a.triangle) < std::tie(b.cell, b.item, b.triangle);
                  }));
        std::size_t left = kFreeComparisons + kComparisonsAnItem * entries_.size();
        for (std::size_t begin = 0, end = 0; begin < entries_.size(); begin = end) {
            while (end < entries_.size() && entries_[end].cell == entries_[begin].cell) ++end;
            compare(std::span(entries_).subspan(begin, end - begin), left);
        }
    }

    /// Compares the triangles of a cell, along the axis of its longest side.
    void compare(std::span<const Entry> entries, std::size_t& left) {
        facets_.clear();
        for (const Entry& entry : entries) facets_.push_back(facet_of(entry));
        WorldBox all = facets_.front().box;
        for (const Facet& facet : facets_) all.include(facet.box);
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
        order_.resize(facets_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return facets_[a].box.low[axis] < facets_[b].box.low[axis]; });
        for (std::size_t i = 0; i < order_.size(); ++i) {
            Facet& facet = facets_[order_[i]];
            std::size_t j = i + 1;
            for (; j < order_.size() && facets_[order_[j]].box.low[axis] <= facet.box.high[axis]; ++j) {
                if (left == 0 || pairs_.size() == kMostPairs) return;
                --left;
                Facet& other = facets_[order_[j]];
                if (overlap(facet, other)) pairs_.push_back({std::min(facet.place, other.place), std::max(facet.place, other.place)});
            }
            constexpr std::uint64_t kUnitsAComparison = 8;
            charge_work(kUnitsAComparison * (j - i));
        }
    }

    [[nodiscard]] Facet facet_of(const Entry& entry) const {
        const Item& item = items_[entry.item];
        const Instance& instance = scene_.scene().instances[item.instance];
        const Mesh& mesh = scene_.source_mesh(instance.mesh);
        const Mat4& m = instance.world_from_object;
        Facet facet{};
        facet.place = {item.instance, entry.triangle};
        facet.material = item.material;
        facet.searched = item.searched;
        facet.both_sides = scene_.material(item.material).double_sided;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f p = mesh.positions[mesh.indices[std::size_t{3} * entry.triangle + k]];
            const Vec3d x = axis(m, 0) * double{p.x}, y = axis(m, 1) * double{p.y}, z = axis(m, 2) * double{p.z}, o = axis(m, 3);
            facet.corner[k] = ((x + y) + z) + o;
            const Vec3d sum = ((absolute(x) + absolute(y)) + absolute(z)) + absolute(o);
            facet.size = {std::max(facet.size.x, sum.x), std::max(facet.size.y, sum.y), std::max(facet.size.z, sum.z)};
        }
        const Vec3d &a = facet.corner[0], &b = facet.corner[1], &c = facet.corner[2];
        facet.mirrored = determinant3(m) < 0.0;
        const auto set = [&](std::size_t k, double u, double v, double w, double size) {
            facet.box.low[k] = std::min({u, v, w}) - kRounding * size;
            facet.box.high[k] = std::max({u, v, w}) + kRounding * size;
        };
        set(0, a.x, b.x, c.x, facet.size.x);
        set(1, a.y, b.y, c.y, facet.size.y);
        set(2, a.z, b.z, c.z, facet.size.z);
        return facet;
    }

    const PreparedData& scene_;
    const std::span<const std::uint8_t> among_;
    std::vector<Item> items_;
    std::vector<WorldBox> reaches_;
    PlaneTable table_;
    std::vector<Entry> entries_;
    ClusterPlanes planes_;
    std::vector<Facet> facets_;  // of the cell that is compared
    std::vector<std::uint32_t> order_;
    std::vector<CoplanarPair> pairs_;
};

}  // namespace

std::vector<CoplanarPair> find_coplanar_pairs(const PreparedData& scene, std::span<const std::uint8_t> among) {
    return CoplanarSearch(scene, among).pairs();
}

CoplanarGroups::CoplanarGroups(const PreparedData& scene, std::span<const CoplanarPair> pairs) {
    if (pairs.empty()) return;
    std::vector<CoplanarPair::Member> members;
    for (const CoplanarPair& pair : pairs) {
        members.push_back(pair.first);
        members.push_back(pair.second);
    }
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    const auto number = [&](const CoplanarPair::Member& member) {
        return static_cast<std::uint32_t>(std::lower_bound(members.begin(), members.end(), member) - members.begin());
    };
    std::vector<std::uint32_t> parent(members.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const CoplanarPair& pair : pairs) {
        const std::uint32_t a = root(number(pair.first)), b = root(number(pair.second));
        parent[std::max(a, b)] = std::min(a, b);
    }
    constexpr std::uint32_t kUnused = 0xffffffffu;
    const std::vector<Instance>& instances = scene.scene().instances;
    rank_.assign(scene.drawn_materials().size(), kUnused);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (!instances[i].visible) continue;
        std::uint32_t& rank = rank_[scene.material_of(i)];
        if (rank == kUnused) rank = static_cast<std::uint32_t>(i);
    }
    of_instance_.resize(instances.size());
    lowest_rank_.assign(members.size() + 1, kUnused);
    for (std::uint32_t i = 0; i < members.size(); ++i) {
        const std::size_t instance = members[i].instance;
        std::vector<std::uint32_t>& groups = of_instance_[instance];
        if (groups.empty()) groups.resize(triangle_count(scene.source_mesh(instances[instance].mesh)));
        const std::uint32_t group = root(i) + 1;
        groups[members[i].triangle] = group;
        lowest_rank_[group] = std::min(lowest_rank_[group], rank_[scene.material_of(instance)]);
    }
}

}  // namespace halflit::raster
