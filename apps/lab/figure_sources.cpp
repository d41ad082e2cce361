#include "apps/lab/figure_sources.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr FigureSource kSources[] = {
    {"[SNY11]", "P.-P. Sloan, D. Nowrouzezahrai, H. Yuan: Wrap Shading. Journal of Graphics, GPU, and Game Tools 15(4), 2011"},
    {"[McA13]", "S. McAuley: energy-conserving wrapped diffuse lighting with a width and a power (w, n), 2013"},
    {"[Lis]", "A silly diffuse shading model: half-Lambert squared from skies and splines"},
    {"[CMSC]", "CMSC 427 computer graphics, lecture slides on shading: Phong, Blinn, ambient, light sources, shading rates"},
    {"[Green04]", "S. Green: Real-Time Approximations to Subsurface Scattering. GPU Gems, chapter 16, 2004"},
    {"[Valve06]", "J. Mitchell, G. McTaggart, C. Green: Shading in Valve's Source Engine. SIGGRAPH course notes, 2006"},
};

}  // namespace

std::vector<FigureSource> sources_in(std::string_view text) {
    std::vector<FigureSource> found;
    for (const FigureSource& source : kSources)
        if (text.find(source.key) != std::string_view::npos) found.push_back(source);
    std::sort(found.begin(), found.end(),
              [&](const FigureSource& a, const FigureSource& b) { return text.find(a.key) < text.find(b.key); });
    return found;
}

}  // namespace halflit::cli
