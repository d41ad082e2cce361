#include "sh/detail/legendre.hpp"

#include <memory>

namespace halflit::sh::detail {
namespace {

/// Recurrence factors as in BasisTable of sh/basis.hpp, but for 64 bands and indexed [m][l].
struct Table {
    double diagonal[kSpectrumBands]{};
    double up[kSpectrumBands][kSpectrumBands]{};
    double back[kSpectrumBands][kSpectrumBands]{};

    Table() {
        double product = 1.0 / (4.0 * kPi);
        for (int m = 0; m < kSpectrumBands; ++m) {
            if (m > 0) product *= (2.0 * m - 1.0) / (2.0 * m);
            diagonal[m] = (m % 2 == 0 ? 1.0 : -1.0) * __builtin_sqrt((2.0 * m + 1.0) * product * (m > 0 ? 2.0 : 1.0));
            for (int l = m + 1; l < kSpectrumBands; ++l) {
                const double span = static_cast<double>(l * l - m * m);
                up[m][l] = __builtin_sqrt((4.0 * l * l - 1.0) / span);
                back[m][l] = __builtin_sqrt((2.0 * l + 1.0) * ((l - 1.0) * (l - 1.0) - m * m) / ((2.0 * l - 3.0) * span));
            }
        }
    }
};

}  // namespace

void legendre(double cos_theta, double sin_theta, std::array<LegendreRow, kSpectrumBands>& rows) {
    static const Table table;
    double power = 1.0;
    for (int m = 0; m < kSpectrumBands; ++m) {
        double before = 0.0, here = table.diagonal[m] * power;
        double* const p = rows[static_cast<std::size_t>(m)].p.data();
        p[0] = here;
        for (int l = m + 1; l < kSpectrumBands; ++l) {
            const double next = cos_theta * here * table.up[m][l] - before * table.back[m][l];
            before = here;
            here = next;
            p[l - m] = here;
        }
        power *= sin_theta;
    }
}

void band_values(const Vec3d* coefficients, Vec3d direction, std::array<Vec3d, kSpectrumBands>& values) {
    // 66 kB, which a small stack does not have: a thread of musl has 128 KiB.
    using Rows = std::array<LegendreRow, kSpectrumBands>;
    const std::unique_ptr<Rows> kept(new Rows);
    Rows& rows = *kept;
    const double ring = __builtin_sqrt(direction.x * direction.x + direction.y * direction.y);
    legendre(direction.z, ring, rows);
    const double x = ring > 0 ? direction.x / ring : 1.0, y = ring > 0 ? direction.y / ring : 0.0;
    values.fill({});
    double c = 1.0, s = 0.0;
    for (int m = 0; m < kSpectrumBands; ++m) {
        for (int l = m; l < kSpectrumBands; ++l) {
            const double p = rows[static_cast<std::size_t>(m)].p[static_cast<std::size_t>(l - m)];
            Vec3d& value = values[static_cast<std::size_t>(l)];
            value = value + coefficients[coefficient_index(l, m)] * (p * c);
            if (m > 0) value = value + coefficients[coefficient_index(l, -m)] * (p * s);
        }
        const double turned = c * x - s * y;
        s = s * x + c * y;
        c = turned;
    }
}

}  // namespace halflit::sh::detail
