// AVX2 with contraction on: what the same source would cost if its bits were free to differ. Measured, never shipped.
#define HALFLIT_ISA avx2_fma
#define HALFLIT_ARCH avx2
#include "bench/kernels/bare_kernel.hpp"
