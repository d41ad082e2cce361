// The wrap family: f(x; w, n) = scale * max(0, (x + w) / (1 + w))^n with x = N.L, and zero for x <= -w.
// Sources: [Green04], [Valve06], [SNY11] eq. 3, [McA13]; the keys resolve in sh/README.md.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"

#include <string>
#include <string_view>

namespace halflit {

/// One member of the wrap family. The named constructors are the models of the literature.
struct Lobe {
    float wrap = 0.0f;       ///< w in [0, 1]: light reaches surfaces with N.L > -w
    float power = 1.0f;      ///< n >= 0
    bool normalize = false;  ///< scale by (n+1) / (2 (1+w)), so that the mean over light directions is Lambert's

    static constexpr Lobe lambert() { return {0.0f, 1.0f, false}; }       ///< max(0, x)
    static constexpr Lobe green(float w) { return {w, 1.0f, false}; }     ///< max(0, (x + w) / (1 + w)) [Green04]
    static constexpr Lobe half_lambert() { return {1.0f, 1.0f, false}; }  ///< (x + 1) / 2
    static constexpr Lobe valve() { return {1.0f, 2.0f, false}; }         ///< ((x + 1) / 2)^2 [Valve06]
    /// The generalised lobe of [SNY11] eq. 3: w = a, n = 1 + a; a = 0 is Lambert, a = 1 is Valve.
    static constexpr Lobe sloan(float a) { return {a, 1.0f + a, false}; }
    /// Any wrap and power, normalised [McA13].
    static constexpr Lobe mcauley(float w, float n) { return {w, n, true}; }

    /// Factor of f: 1 if not `normalize`.
    [[nodiscard]] constexpr float scale() const { return normalize ? (power + 1.0f) / (2.0f * (1.0f + wrap)) : 1.0f; }
    friend constexpr bool operator==(const Lobe&, const Lobe&) = default;
};

/// Largest wrap. Above it every normal is lit, and the norm has another formula.
inline constexpr float kMaxLobeWrap = 1.0f;
/// Largest power. Sharper lobes are refused; they are almost points of light.
inline constexpr float kMaxLobePower = 10000.0f;

/// Fails (bad_input) unless w is in [0, kMaxLobeWrap] and n in [0, kMaxLobePower]; the message begins with "wrap" or "power" and says why.
[[nodiscard]] HALFLIT_API Result<void> check_lobe(const Lobe& lobe);

/// A model of the literature, by the name that users type. Its power is power + power_per_wrap w.
struct NamedLobe {
    std::string_view name;        ///< lower case, as in kNamedLobes
    bool takes_wrap;              ///< the user chooses w; otherwise it is `wrap`
    float wrap;                   ///< w where the user does not choose it
    float power, power_per_wrap;  ///< the lobe's power is power + power_per_wrap w
    bool normalize;               ///< as in Lobe
};
/// All models, by the names of Lobe's constructors.
inline constexpr NamedLobe kNamedLobes[] = {{"lambert", false, 0, 1, 0, false},      {"green", true, 0, 1, 0, false},
                                            {"half-lambert", false, 1, 1, 0, false}, {"valve", false, 1, 2, 0, false},
                                            {"sloan", true, 0, 1, 1, false},         {"mcauley", true, 0, 1, 1, true}};
/// Default wrap of a model that takes one.
inline constexpr float kUsualWrap = 0.5f;

/// Finds a model by its name; null for an unknown one.
[[nodiscard]] HALFLIT_API const NamedLobe* find_named_lobe(std::string_view name);
/// "lambert, green, .. or mcauley", for messages.
[[nodiscard]] HALFLIT_API std::string lobe_names();

/// Warning for a lobe that is allowed but may surprise, one with a power below 1; empty for all others.
[[nodiscard]] HALFLIT_API std::string lobe_warning(const Lobe& lobe);

}  // namespace halflit
