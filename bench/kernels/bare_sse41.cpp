#define HALFLIT_ISA sse41
#define HALFLIT_ARCH sse4_1
#include "bench/kernels/bare_kernel.hpp"
