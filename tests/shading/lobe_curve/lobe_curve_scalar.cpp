#define HALFLIT_ISA scalar
#include "lobe_curve_kernel.hpp"
