#define HALFLIT_ISA scalar
#include "elementary_kernel.hpp"
