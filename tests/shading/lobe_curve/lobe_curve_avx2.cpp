#define HALFLIT_ISA avx2
#define HALFLIT_ARCH avx2
#include "lobe_curve_kernel.hpp"
