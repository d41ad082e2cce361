// Packing of visible pixels into full shading blocks. A tile has one open list for each material; a list is shaded when it has kBlockSize
// fragments. Runs of pixels of one triangle stay neighbours in a list, so that interpolation loads the triangle once. The packing cannot
// change a value.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/fragment_block.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace halflit::raster {

/// Leaves the fragments of a row for whose index `keep` is true.
template <class Keep>
void keep_fragments(PixelFragments& row, const Keep& keep) {
    int kept = 0;
    for (int i = 0; i < row.count; ++i) {
        const bool stays = keep(i);
        row.id[kept] = row.id[i], row.x_px[kept] = row.x_px[i], row.samples[kept] = row.samples[i];
        kept += stays ? 1 : 0;
    }
    row.count = kept;
}

/// Fragments of one material, at most a block.
struct FragmentList {
    /// Room behind a full list, as whole rows of fragments are copied.
    static constexpr int kRoom = shading::kBlockSize + kPixelsARow;

    int material = 0;
    int count = 0;
    alignas(64) std::uint32_t id[kRoom];  ///< triangle id
    alignas(64) std::int32_t x_px[kRoom], y_px[kRoom];
    alignas(64) std::int32_t samples[kRoom];  ///< bit s: sample s shows this fragment

    void push(std::uint32_t triangle, int x, int y, unsigned sample_bits) {
        id[count] = triangle;
        x_px[count] = x;
        y_px[count] = y;
        samples[count] = static_cast<std::int32_t>(sample_bits);
        ++count;
    }
    /// Appends fragments [first, first + n) of row y; n: at most as many as fit.
    void append(const PixelFragments& row, int first, int n, int y) {
        for (int i = 0; i < n; i += kPixelsARow) {
            std::memcpy(id + count + i, row.id + first + i, sizeof(std::uint32_t) * kPixelsARow);
            std::memcpy(x_px + count + i, row.x_px + first + i, sizeof(std::int32_t) * kPixelsARow);
            std::memcpy(samples + count + i, row.samples + first + i, sizeof(std::int32_t) * kPixelsARow);
            std::fill_n(y_px + count + i, kPixelsARow, y);
        }
        count += n;
    }
    [[nodiscard]] bool full() const { return count == shading::kBlockSize; }
};

/// The open lists of a tile, found by material; lists are reused from tile to tile.
class FragmentQueue {
public:
    /// Forgets all lists; `materials` is the number of materials of the frame.
    void begin(std::size_t materials) {
        if (slot_.size() != materials || ++epoch_ == 0) {
            slot_.assign(materials, {});
            epoch_ = 1;
        }
        used_ = 0;
        free_.reserve(free_.size() + closed_.size());  // may throw, while no list is moved
        for (auto& list : closed_) free_.push_back(std::move(list));
        closed_.clear();
    }
    FragmentList& of(int material) {
        Slot& s = slot_[static_cast<std::size_t>(material)];
        if (s.epoch != epoch_) {
            if (used_ == lists_.size()) lists_.push_back(std::make_unique<FragmentList>());
            s = {epoch_, static_cast<std::uint32_t>(used_++)};
            lists_[s.list]->material = material;
            lists_[s.list]->count = 0;
        }
        return *lists_[s.list];
    }
    [[nodiscard]] std::size_t size() const { return used_; }
    FragmentList& operator[](std::size_t i) { return *lists_[i]; }

    /// Keeps an open list as it is, and opens an empty one in its place.
    FragmentList& close(FragmentList& list) {
        if (free_.empty()) free_.push_back(std::make_unique<FragmentList>());
        closed_.emplace_back();
        // Nothing throws from here on.
        auto& open = lists_[slot_[static_cast<std::size_t>(list.material)].list];
        closed_.back() = std::move(open);
        open = std::move(free_.back());
        free_.pop_back();
        open->material = list.material;
        open->count = 0;
        return *open;
    }
    /// Closed lists, those of a material together, each material's in the order of closing.
    std::span<std::unique_ptr<FragmentList>> closed() {
        std::stable_sort(closed_.begin(), closed_.end(), [](const auto& a, const auto& b) { return a->material < b->material; });
        return closed_;
    }

private:
    struct Slot {
        std::uint32_t epoch = 0, list = 0;
    };
    std::vector<Slot> slot_;
    std::vector<std::unique_ptr<FragmentList>> lists_, closed_, free_;
    std::size_t used_ = 0;
    std::uint32_t epoch_ = 0;
};

}  // namespace halflit::raster
