// Working memory.
#pragma once

#include "raster/detail/stop_signal.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace halflit::raster {

/// Buffer of uninitialised elements. Growing drops the old contents.
template <class T>
class RawBuffer {
public:
    T* reserve(std::size_t count) {
        if (count > capacity_) {
            data_.reset();
            capacity_ = 0;  // also if the allocation throws
            data_ = std::make_unique_for_overwrite<T[]>(count);
            capacity_ = count;
        }
        return data_.get();
    }
    /// The same; the memory counts as the call's. Throws Stopped beyond its limit.
    T* reserve(std::size_t count, StopSignal& stop) {
        share_.hold(stop, std::max(count, capacity_) * sizeof(T));
        return reserve(count);
    }
    [[nodiscard]] T* data() { return data_.get(); }
    [[nodiscard]] const T* data() const { return data_.get(); }
    [[nodiscard]] std::size_t capacity() const { return capacity_; }

private:
    std::unique_ptr<T[]> data_;
    std::size_t capacity_ = 0;
    MemoryShare share_;
};

}  // namespace halflit::raster
