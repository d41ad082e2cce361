// The instruction sets of a module whose kernels of wasm128 come later or not at all. It stands for shading/isa.cpp.
#include "apps/web/kernels_apart.hpp"

#define HALFLIT_HAS_WASM128 web::has_wasm128()
#include "shading/isa.cpp"
