#define HALFLIT_ISA sse2
#define HALFLIT_ARCH sse2
#include "lobe_curve_kernel.hpp"
