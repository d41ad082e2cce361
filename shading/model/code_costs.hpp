// Codes that errors of light cost, each part as if it were alone, after a tone curve.
#pragma once

#include "halflit/shading.hpp"
#include "shading/model/code_bounds.hpp"

#include <algorithm>

namespace halflit::shading {

/// The bounds of code_bounds.hpp, enlarged by what a tone curve may do to errors of each kind.
class CodeCosts {
public:
    /// Costs without a curve.
    constexpr CodeCosts() = default;
    constexpr explicit CodeCosts(const ErrorGrowth& growth) : growth_(growth) {}

    [[nodiscard]] double absolute(double delta) const {
        return most(std::min(codes_of_absolute(growth_.absolute * delta), growth_.other * codes_of_absolute(delta)));
    }
    [[nodiscard]] double relative(double r) const { return most(relative_growth() * codes_of_relative(r)); }
    [[nodiscard]] double specular(double peak, int count, double constant, double linear) const {
        return other(codes_of_specular(peak, count, constant, linear));
    }
    /// Codes of an error that is neither absolute nor relative, given those without a curve.
    [[nodiscard]] double other(double codes) const { return most(growth_.other * codes); }

    /// absolute(d) <= at_black() d, and relative(r) <= at_white() ln(1 + r).
    [[nodiscard]] double at_black() const { return kSlopeAtBlack * std::min(growth_.absolute, growth_.other); }
    [[nodiscard]] double at_white() const { return kSlopeAtWhite * relative_growth(); }

    [[nodiscard]] const ErrorGrowth& growth() const { return growth_; }
    friend bool operator==(const CodeCosts&, const CodeCosts&) = default;

private:
    [[nodiscard]] static double most(double codes) { return std::min(codes, 255.0); }
    [[nodiscard]] double relative_growth() const { return std::min(growth_.relative, growth_.other); }
    ErrorGrowth growth_;
};

}  // namespace halflit::shading
