// t^1.3 for t in [0, 1] from the kernels' source, on a processor with fused multiply-add. It is compiled twice: under the project's flags,
// which forbid fusing, and under the compiler's own, which fuse. CMake gives the two objects their names and flags.
#pragma once

namespace halflit::testing {

void power_uncontracted(const float* t, float* out, int count);
void power_contracted(const float* t, float* out, int count);

}  // namespace halflit::testing
