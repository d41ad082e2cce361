// Sample for the layering test: points right.
#include "shading/plan/plan.hpp"
