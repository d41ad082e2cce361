// Stands for raster/kernels/registry.cpp and shading/kernels/registry.cpp.
#include "apps/web/kernels_apart.hpp"

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/shade_kernels.hpp"

namespace halflit {
namespace {

const raster::RasterKernels* raster_wasm128 = nullptr;
const shading::ShadeKernels* shade_wasm128 = nullptr;

}  // namespace

namespace web {

bool has_wasm128() { return raster_wasm128 != nullptr; }

void use_wasm128(const void* raster, const void* shade) {
    raster_wasm128 = static_cast<const raster::RasterKernels*>(raster);
    shade_wasm128 = static_cast<const shading::ShadeKernels*>(shade);
}

}  // namespace web

namespace raster {

extern const RasterKernels raster_kernels_scalar;

const RasterKernels& raster_kernels(Isa isa) {
    return isa == Isa::wasm128 && raster_wasm128 != nullptr ? *raster_wasm128 : raster_kernels_scalar;
}

}  // namespace raster

namespace shading {

extern const ShadeKernels shade_kernels_scalar;

const ShadeKernels& shade_kernels(Isa isa) {
    return isa == Isa::wasm128 && shade_wasm128 != nullptr ? *shade_wasm128 : shade_kernels_scalar;
}

}  // namespace shading
}  // namespace halflit
