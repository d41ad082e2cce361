// Arithmetic that a compiler must not change. Compiled and run at configuration (cmake/value_flags.cmake): prints what is wrong, and
// returns 1 then. The inputs are volatile, so that nothing is computed by the compiler.
#include <cstdio>

#if defined(__GNUC__)
#define PROBE extern "C" __attribute__((noinline, used))
#else
#define PROBE extern "C"
#endif

// Looked at for fused operations.
PROBE float halflit_multiply_add(float a, float b, float c) { return a * b + c; }

namespace {

volatile float one_ulp = 1.00000011920928955f;  // 1 + 2^-23
volatile float tie = 1.000244140625f;           // 1 + 2^-12: its square is between two floats
volatile float large = 1e8f, one = 1.0f, three = 3.0f, minus_zero = -0.0f, zero = 0.0f, tiny = 1e-40f;
volatile double wide[3] = {0.1, 0.2, 0.3};

struct Triple {
    double x, y, z;
};
PROBE void halflit_round(const volatile double* from, Triple& to) {
    to = {static_cast<double>(static_cast<float>(from[0])), static_cast<double>(static_cast<float>(from[1])),
          static_cast<double>(static_cast<float>(from[2]))};
}

int wrong = 0;
void check(bool good, const char* what) {
    if (good) return;
    std::printf("%s%s", wrong == 0 ? "" : ", ", what);
    wrong = 1;
}

}  // namespace

int main() {
    const float u = one_ulp, square = u * u, t = tie, l = large, o = one, d = three, z = zero, m = minus_zero, s = tiny;
    check(halflit_multiply_add(u, u, -square) == 0.0f, "multiplication and addition are fused");
    check((l + o) - l == 0.0f, "sums are reordered");
    check(5.0f * o / d == 5.0f / 3.0f && 7.0f * o / d == 7.0f / 3.0f && 10.0f * o / d == 10.0f / 3.0f,
          "divisions become multiplications by a reciprocal");
    check(o / (m + z) > 0.0f, "the sign of zero is lost");
    check(!((z / z) == (z / z)), "NaN is taken for a number");
    check(s * o != 0.0f, "denormal numbers are flushed to zero");
    check(static_cast<double>(t * t) == 1.00048828125, "floats have excess precision");
    Triple rounded;
    halflit_round(wide, rounded);
    check(rounded.x != 0.1 && rounded.y != 0.2 && rounded.z != 0.3, "rounding of double to float is dropped");
    return wrong;
}
