// The module of the kernels alone (kernels_apart.hpp): what it exports, and what they call of the C library.
#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <cstddef>

namespace halflit::raster {
extern const RasterKernels raster_kernels_wasm128;
}
namespace halflit::shading {
extern const ShadeKernels shade_kernels_wasm128;
}

extern "C" {

const void* halflit_raster_kernels() { return &halflit::raster::raster_kernels_wasm128; }
const void* halflit_shade_kernels() { return &halflit::shading::shade_kernels_wasm128; }

// Single instructions of WebAssembly.
void* memcpy(void* to, const void* from, std::size_t size) {
    __builtin_memcpy(to, from, size);
    return to;
}
void* memset(void* to, int value, std::size_t size) {
    __builtin_memset(to, value, size);
    return to;
}

}  // extern "C"
