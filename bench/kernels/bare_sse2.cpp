#define HALFLIT_ISA sse2
#define HALFLIT_ARCH sse2
#include "bench/kernels/bare_kernel.hpp"
