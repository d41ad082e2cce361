#include "raster/passes/used_vertices.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace halflit::raster {
namespace {

/// A set of numbers, and the place of each in their order.
class NumberSet {
public:
    void clear() { numbers_.clear(); }
    void add(std::uint32_t number) { numbers_.push_back(number); }
    /// Ends adding. Numbers that lie close together are looked up in a list of all between them, others by bisection.
    void sort() {
        const auto [least, most] = std::minmax_element(numbers_.begin(), numbers_.end());
        least_ = *least;
        const std::size_t range = std::size_t{*most} - *least + 1;
        is_dense_ = range <= 64 + 8 * numbers_.size();
        if (!is_dense_) {
            std::sort(numbers_.begin(), numbers_.end());
            numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
            return;
        }
        place_.assign(range, 0);
        for (const std::uint32_t number : numbers_) place_[number - least_] = 1;
        numbers_.clear();
        for (std::size_t i = 0; i < range; ++i) {
            if (place_[i] == 0) continue;
            place_[i] = static_cast<std::uint32_t>(numbers_.size());
            numbers_.push_back(least_ + static_cast<std::uint32_t>(i));
        }
    }
    [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }
    [[nodiscard]] std::uint32_t place(std::uint32_t number) const {
        if (is_dense_) return place_[number - least_];
        return static_cast<std::uint32_t>(std::lower_bound(numbers_.begin(), numbers_.end(), number) - numbers_.begin());
    }

private:
    std::vector<std::uint32_t> numbers_, place_;
    std::uint32_t least_ = 0;
    bool is_dense_ = false;
};

void pad_to_four(UsedVertices& used) {
    while (used.screen.size() % 4 != 0) {
        used.screen.emplace_back();
        used.mesh_vertex.push_back(0);
    }
}

/// base_of(draw): the number of the draw's first vertex where records have theirs from. copy(draw, v): appends the vertex base + v.
template <class BaseOf, class Copy>
void copy_vertices(Chunk& chunk, std::span<const Draw> draws, const BaseOf& base_of, const Copy& copy) {
    UsedVertices& used = chunk.used;
    NumberSet units;  // vertices, or quads of four
    auto clip = chunk.clip_vertices.begin();
    for (auto first = chunk.records.begin(); first != chunk.records.end();) {
        const std::uint32_t number = first->draw();
        const auto last = std::find_if(first, chunk.records.end(), [=](const TriangleRecord& r) { return r.draw() != number; });
        const auto clip_last = std::find_if(clip, chunk.clip_vertices.end(), [=](const ClipVertex& v) { return v.draw != number; });
        const auto for_each_vertex = [&](const auto& use) {
            for (auto r = first; r != last; ++r)
                for (std::uint32_t& v : r->vertex)
                    if (v < kClipVertex) use(v);
            for (auto c = clip; c != clip_last; ++c)
                for (std::uint32_t& v : c->parent) use(v);
        };
        const Draw& draw = draws[number];
        const std::uint32_t base = base_of(draw), shift = draw.quads() ? 2 : 0;
        units.clear();
        for_each_vertex([&](std::uint32_t v) { units.add((v - base) >> shift); });
        units.sort();
        if (draw.quads()) pad_to_four(used);
        const auto start = static_cast<std::uint32_t>(used.screen.size());
        used.parts.push_back({number, start});
        for (const std::uint32_t unit : units.numbers())
            for (std::uint32_t v = unit << shift; v < (unit + 1) << shift; ++v) copy(draw, v);
        for_each_vertex([&](std::uint32_t& v) {
            const std::uint32_t old = v - base, unit = old >> shift;
            v = start + (units.place(unit) << shift) + (old - (unit << shift));
        });
        first = last, clip = clip_last;
    }
    pad_to_four(used);
}

}  // namespace

void copy_used_vertices(Chunk& chunk, std::span<const Draw> draws, const ScreenVertex* screen) {
    copy_vertices(
        chunk, draws, [](const Draw& draw) { return static_cast<std::uint32_t>(draw.vertex_base); },
        [&](const Draw& draw, std::uint32_t v) {
            chunk.used.screen.push_back(screen[draw.vertex_base + v]);
            chunk.used.mesh_vertex.push_back(v >> draw.vertex_shift());
        });
}

void drop_unused_vertices(Chunk& chunk, std::span<const Draw> draws) {
    const UsedVertices before = std::exchange(chunk.used, {});
    copy_vertices(
        chunk, draws, [](const Draw&) { return 0u; },
        [&](const Draw&, std::uint32_t v) {
            chunk.used.screen.push_back(before.screen[v]);
            chunk.used.mesh_vertex.push_back(before.mesh_vertex[v]);
        });
}

}  // namespace halflit::raster
