#define HALFLIT_ISA neon64
#define HALFLIT_ARCH neon64
#include "bench/kernels/bare_kernel.hpp"
