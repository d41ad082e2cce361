#define HALFLIT_ISA sse41
#define HALFLIT_ARCH sse4_1
#include "lobe_curve_kernel.hpp"
