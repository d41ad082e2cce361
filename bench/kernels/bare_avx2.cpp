#define HALFLIT_ISA avx2
#define HALFLIT_ARCH avx2
#include "bench/kernels/bare_kernel.hpp"
