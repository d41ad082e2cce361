// The order in which splats are blended.
#pragma once

#include "raster/detail/raw_buffer.hpp"
#include "raster/detail/stop_signal.hpp"

#include <cstdint>
#include <span>

namespace halflit::raster {

/// Sorts the numbers of splats by their distances, which are not below 0; those at one distance by number. scratch: working memory.
void sort_by_distance(std::span<std::uint32_t> numbers, const double* distances, RawBuffer<std::uint64_t>& scratch, StopSignal& stop);

}  // namespace halflit::raster
