// How an error budget is split: every share in one place, with where it comes from.
#pragma once

namespace halflit::shading {

/// A budget of E codes is spent in the order of the members; each share is of what the parts before it have left. Rounding comes first: it
/// cannot be chosen, and what it takes is gone for all others.
struct BudgetShares {
    /// Of E, for the bands that environments leave out. First, because the orders are picked before materials are looked at, and because
    /// bands come in whole numbers: usually much less is used, and what is not used is left for the parts below.
    double environment = 0.3;
    /// A pixel may meet two such sums: light through the lobe, and what a surface reflects. Each gets half.
    [[nodiscard]] constexpr double each_environment() const { return 0.5 * environment; }

    /// Of what the poorest material has left, for light beyond the lights' cutoff radii. One radius serves all materials, so that the
    /// poorest one decides; a radius grows with the inverse root of its share, so that half the share is only 1.4 times the radius.
    double cutoff = 0.25;

    /// Of a material's rest, for the lobe: a curve or a shorter polynomial either fits or not, and a lobe's curve needs a tenth of a code
    /// where a highlight's needs half a code for the same gain, so that the larger part stays for the highlights.
    double lobe = 0.4;

    /// Of the rest, for highlights: half of it for what is cut off below their curve, nearly half for the curve itself. Where powers stay,
    /// half of it for a shorter power and the rest for what is left out. The hundredths stay for the rounding of this arithmetic.
    double specular_cut = 0.5, specular_curve = 0.48;
    double specular_power = 0.5, specular_left_out = 0.98;
};
inline constexpr BudgetShares kBudgetShares;

}  // namespace halflit::shading
