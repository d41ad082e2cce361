// Split of an error budget: every share in one place, with its reason.
#pragma once

namespace halflit::shading {

/// A budget of E codes is spent in the order of the members. Each share is a share of what the parts before it have left.
struct BudgetShares {
    /// Share of E for the bands that environments leave out. It is spent before the others, because the orders are picked before materials
    /// are looked at. Bands come in whole numbers, so usually much less is used; the rest goes to the parts below. Without lights there are
    /// none, but for roundings.
    double environment = 0.3, environment_alone = 0.95;

    /// Share of what the poorest material has left, for light beyond the lights' cutoff radii. One radius serves all materials, so the
    /// poorest one decides. A radius grows with the inverse square root of its share: half the share makes it only 1.4 times larger.
    double cutoff = 0.25;

    /// Share of a material's rest, for the lobe. A curve or a shorter polynomial either fits or not. A lobe's curve needs a tenth of a code
    /// where a highlight's needs half a code for the same gain, so the larger part stays for the highlights.
    double lobe = 0.4;

    /// Share of the rest that is kept for light in cells, where they are used; they get what the highlights leave, too. Cells replace most
    /// of the work that the parts below make cheaper. Most of it is relative to the light of the cell; the absolute part serves cells that
    /// are nearly dark.
    double cells = 0.7, cells_of_rest = 0.99, cells_relative = 0.85;

    /// Shares of the rest, for highlights with a curve: half for what is cut off below it, nearly half for the curve itself. For highlights
    /// with powers: half for a shorter power, and nearly all that is left then for weak highlights left out. The missing hundredths cover
    /// the rounding of this arithmetic.
    double specular_cut = 0.5, specular_curve = 0.48;
    double specular_power = 0.5, specular_left_out = 0.98;
};
inline constexpr BudgetShares kBudgetShares;

}  // namespace halflit::shading
