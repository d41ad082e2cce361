// Working memory.
#pragma once

#include "raster/detail/stop_signal.hpp"
#include "shading/large_block.hpp"

#include <algorithm>
#include <cstddef>

namespace halflit::raster {

/// Buffer of uninitialised elements. Growing drops the old contents.
template <class T>
class RawBuffer {
public:
    T* reserve(std::size_t count) {
        if (count > capacity_) {
            data_.reset();
            capacity_ = 0;  // also if the allocation throws
            data_ = shading::make_large_block<T>(count);
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
    shading::LargeBlock<T> data_;
    std::size_t capacity_ = 0;
    MemoryShare share_;
};

}  // namespace halflit::raster
