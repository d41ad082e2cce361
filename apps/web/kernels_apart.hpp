// Kernels of wasm128 in a module of their own. A host that cannot validate SIMD leaves it out, and all other code is there once.
#pragma once

namespace halflit::web {

/// True once the kernels were handed over.
[[nodiscard]] bool has_wasm128();

/// Hands them over: addresses of the tables RasterKernels and ShadeKernels, which the other module's exports give.
void use_wasm128(const void* raster, const void* shade);

}  // namespace halflit::web
