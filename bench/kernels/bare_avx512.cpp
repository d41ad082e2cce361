#define HALFLIT_ISA avx512
#define HALFLIT_ARCH avx512f
#include "bench/kernels/bare_kernel.hpp"
