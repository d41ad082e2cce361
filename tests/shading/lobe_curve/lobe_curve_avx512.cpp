#define HALFLIT_ISA avx512
#define HALFLIT_ARCH avx512f
#include "lobe_curve_kernel.hpp"
