// Real spherical harmonics, bands 0..9, by Cartesian recurrences: no angle is ever formed, so the poles are as accurate as
// the equator (error below 4e-15 in double: tests/sh/basis_test.cpp).
//
// Convention: that of [Sloan08], polar axis z, Condon-Shortley sign included, orthonormal over the sphere:
//     Y_0 = .2821,  Y_1 = (-.4886 y, +.4886 z, -.4886 x) for m = -1, 0, 1.
// Coefficient (l, m) has index l*l + l + m. "Order N" means the bands 0..N-1, N*N coefficients. Coefficients made with the other
// sign convention differ by a factor -1 for odd m.
#pragma once

#include "halflit/math.hpp"
#include "sh/trig.hpp"

namespace halflit::sh {

inline constexpr int kMaxBands = 10;
inline constexpr int kMaxCoefficients = kMaxBands * kMaxBands;

constexpr int coefficient_count(int bands) { return bands * bands; }
constexpr int coefficient_index(int l, int m) { return l * l + l + m; }
/// The band that a coefficient belongs to.
constexpr int band_of(int index) {
    int l = 0;
    while ((l + 1) * (l + 1) <= index) ++l;
    return l;
}

namespace detail {

/// Square root by Newton's iteration from above, for tables: std::sqrt may not be constexpr. Within 1 ulp for x in [1e-6, 1e6].
constexpr double table_sqrt(double x) {
    double y = x > 1.0 ? x : 1.0;
    for (int i = 0; i < 64; ++i) {
        const double next = 0.5 * (y + x / y);
        if (!(next < y)) break;
        y = next;
    }
    return x > 0.0 ? y : 0.0;
}

/// Factors of the recurrence for Y_lm = q_lm(z) (cos or sin of m phi) sin^m theta:
///     q_mm = diagonal[m],  q_lm = up[l][m] z q_{l-1,m} - back[l][m] q_{l-2,m}.
struct BasisTable {
    double diagonal[kMaxBands]{};
    double up[kMaxBands][kMaxBands]{};
    double back[kMaxBands][kMaxBands]{};
};

constexpr BasisTable make_basis_table() {
    BasisTable t;
    double product = 1.0 / (4.0 * kPi);  // 1/(4 pi) (2m-1)!!/(2m)!!
    for (int m = 0; m < kMaxBands; ++m) {
        if (m > 0) product *= (2.0 * m - 1.0) / (2.0 * m);
        t.diagonal[m] = (m % 2 == 0 ? 1.0 : -1.0) * table_sqrt((2.0 * m + 1.0) * product * (m > 0 ? 2.0 : 1.0));
        for (int l = m + 1; l < kMaxBands; ++l) {
            const double span = static_cast<double>(l * l - m * m);
            t.up[l][m] = table_sqrt((4.0 * l * l - 1.0) / span);
            t.back[l][m] = table_sqrt((2.0 * l + 1.0) * ((l - 1.0) * (l - 1.0) - m * m) / ((2.0 * l - 3.0) * span));
        }
    }
    return t;
}

inline constexpr BasisTable kBasisTable = make_basis_table();

/// Turns a table's double into a T. Types other than double (float, a batch of floats) get the nearest float.
template <class T>
struct Constant {
    static HALFLIT_INLINE constexpr T of(double value) { return T(static_cast<float>(value)); }
};
template <>
struct Constant<double> {
    static HALFLIT_INLINE constexpr double of(double value) { return value; }
};

}  // namespace detail

namespace detail {

/// A loop whose index is a compile-time constant, so that table entries become immediate values in every build.
template <int I>
struct Index {
    static constexpr int value = I;
};
template <int Begin, int End, class Fn>
HALFLIT_INLINE constexpr void static_for(const Fn& fn) {
    if constexpr (Begin < End) {
        fn(Index<Begin>{});
        static_for<Begin + 1, End>(fn);
    }
}

}  // namespace detail

/// Evaluates all basis functions of the bands 0..N-1 at the unit vector d. A length |d| = 1 - e causes a relative error of l(l+1)/2 e in
/// band l.
template <int N, class T>
HALFLIT_INLINE constexpr void evaluate_basis(Vec3<T> d, T (&y)[N * N]) {
    static_assert(N >= 1 && N <= kMaxBands);
    using C = detail::Constant<T>;
    T c = C::of(1.0), s = C::of(0.0);  // real and imaginary part of (x + iy)^m: sin^m theta times cos and sin of m phi
    detail::static_for<0, N>([&](auto order) __attribute__((always_inline)) {
        constexpr int m = decltype(order)::value;
        constexpr double diagonal = detail::kBasisTable.diagonal[m];
        T before = C::of(0.0), q = C::of(diagonal);
        detail::static_for<m, N>([&](auto band) __attribute__((always_inline)) {
            constexpr int l = decltype(band)::value;
            y[coefficient_index(l, m)] = q * c;
            if constexpr (m > 0) y[coefficient_index(l, -m)] = q * s;
            if constexpr (l + 1 < N) {
                constexpr double up = detail::kBasisTable.up[l + 1][m], back = detail::kBasisTable.back[l + 1][m];
                const T next = (d.z * q) * C::of(up) - before * C::of(back);
                before = q;
                q = next;
            }
        });
        const T turned = c * d.x - s * d.y;
        s = s * d.x + c * d.y;
        c = turned;
    });
}

}  // namespace halflit::sh
