// Sample for the layering test: what kernels must not use.
#include <cmath>
inline float a(float x) { return std::pow(x, 2.0f); }
inline auto b(__m128 x) { return _mm_rsqrt_ps(x); }
