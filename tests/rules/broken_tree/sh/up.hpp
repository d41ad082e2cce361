// Sample for the layering test: points right, twice.
#include "halflit/lobe.hpp"
#include "shading/plan/plan.hpp"
