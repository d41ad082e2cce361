#include "tests/adversary/faults.hpp"

namespace halflit::adversary {
namespace {

constexpr KnownFault kKnown[] = {
    {"soft-split: light that a shadow leaves of a wrapped lobe is nearly black, where the fitted lobe's absolute error is not",
     kAvoidSoftSplit, "6:14945111,96:10867405,97:3347145,304:16777215,354:7298178,355:12773029,375:12909907", false},
    {"a metal's highlight times its texture: the normalisation (s + 8) / 8 is left out of the bound on the texture's error",
     kAvoidMetalTextures,
     "3:6772285,39:16777215,105:16546191,107:15099851,160:16777215,161:16777215,163:16777215,165:16484945,169:16777215,170:10066329",
     false},
    {"suns taken out of an environment become points of light: their size is not in the bound, nor in the reference", kAvoidSuns,
     "65:16777215,73:6628581,74:12000000,76:5000000,77:12000000,78:16674785,81:16777215,82:16777215,96:8489986,97:8000000,288:5000000",
     false},
    {"zero normals under an environment are documented as dark, and get the light of some direction", kAvoidZeroNormals,
     "65:16777215,304:14345712", false},
    {"texture coordinates that are NaN count as 0, but make the reference NaN, which is written as 0", kAvoidOddCoordinates,
     "192:15942424,310:16517499", false},
    {"a normal map whose texels point apart: between them normals are shorter than the tenth that the bound on rounding takes as the least",
     kAvoidShortNormals, "34:2718288,192:16616385,193:11199502,195:15620556,197:8585976,198:15952995,200:16777215", false},
    {"a normal map on vertices without normals made a direction of rounding errors", kAvoidZeroNormals,
     "192:12583841,193:5491881,195:9137630,197:10752979,304:14174080,310:16104607,416:13416441,419:15533396", false},
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
