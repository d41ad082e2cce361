#define HALFLIT_ISA neon64
#define HALFLIT_ARCH neon64
#include "lobe_curve_kernel.hpp"
