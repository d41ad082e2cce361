#define HALFLIT_ISA scalar
#include "bench/kernels/bare_kernel.hpp"
