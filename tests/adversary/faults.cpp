#include "tests/adversary/faults.hpp"

namespace halflit::adversary {
namespace {

constexpr KnownFault kKnown[] = {
    {"soft-split: the excess of a wrapped lobe over max(0, N.L) is nearly black where the curve's absolute error is not", kAvoidSoftSplit,
     "", true},
    {"a metal's highlight times its texture: the normalisation (s + 8) / 8 is left out of the bound on the texture's error",
     kAvoidMetalTextures, "", true},
    {"suns taken out of an environment become points of light: their size is not in the bound, nor in the reference", kAvoidSuns, "", true},
    {"zero normals under an environment are documented as dark, and get the light of some direction", kAvoidZeroNormals, "", true},
    {"texture coordinates that are NaN count as 0, but make the reference NaN, which is written as 0", kAvoidOddCoordinates, "", true},
    {"a normal map whose texels point apart: between them normals are shorter than the tenth that the bound on rounding takes as the least",
     kAvoidShortNormals,
     "192:16616385,193:11199502,195:15620556,197:8585976,198:15952995,200:16777215,289:16777215,416:9683322,440:6136462", true},
};

}  // namespace

std::span<const KnownFault> known_faults() { return kKnown; }

AvoidSet avoided() {
    AvoidSet all = 0;
    for (const KnownFault& fault : kKnown) all |= fault.open ? fault.avoid : 0u;
    return all;
}

std::string explanation(Judge& judge, const Genome& genome, AvoidSet avoid) {
    if (judge.judge(genome, avoid | avoided()).broken()) return "";
    std::string text;
    for (const KnownFault& fault : kKnown) {
        const bool present = fault.open && (avoid & fault.avoid) == 0;
        if (present && !judge.judge(genome, avoid | fault.avoid).broken()) text += (text.empty() ? "" : ", or ") + std::string(fault.what);
    }
    return text.empty() ? "several known faults together" : text;
}

}  // namespace halflit::adversary
