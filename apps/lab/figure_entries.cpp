#include "apps/lab/figure_entries.hpp"

namespace halflit::cli {

std::span<const FigureEntry> all_figures() {
    static constexpr FigureEntry kFigures[] = {
        {"wrap-form", "Wrap on a bust that is lit from the side and behind", "[SNY11] fig. 1", &make_wrap_form_figure},
        {"backlight", "Two lobes of wrap 1, lit from behind", "[SNY11] fig. 2; [Green04], [Valve06]", &make_backlight_figure},
        {"curves", "The lobes over the angle", "[SNY11] fig. 3 and eq. 3", &make_curves_figure},
        {"green-sloan", "Green's lobe and Sloan's at the same wrap", "[SNY11] fig. 4", &make_green_sloan_figure},
        {"sh-error", "Error of Sloan's lobe in order-3 spherical harmonics", "[SNY11] fig. 5", &make_sh_error_figure},
        {"band-energy", "Energy of Sloan's lobe in each band", "[SNY11] fig. 6", &make_band_energy_figure},
        {"normalized", "Wrapped lobes, without and with normalization", "[McA13], before and after", &make_normalized_figure},
        {"area-light", "A sphere of light, and the wrapped lobes nearest to it", "[McA13], the widths and powers", &make_area_light_figure},
        {"half-lambert", "Lambert, half-Lambert and its square", "[Lis]; [Valve06]", &make_half_lambert_figure},
        {"gamma", "Half-Lambert in sRGB codes and in linear light", "[Lis]; [Valve06]", &make_gamma_figure},
        {"shading-rates", "Light computed once per triangle, vertex and pixel", "[CMSC], shading strategies", &make_shading_rates_figure},
        {"highlights", "Phong's highlight and Blinn's", "[CMSC], Phong model and Blinn model", &make_highlights_figure},
        {"light-sources", "Directional, point and spot light", "[CMSC], light sources", &make_light_sources_figure},
        {"terminator", "Shadow maps and wrapped light at the terminator", "[SNY11] sec. 3", &make_terminator_figure},
        {"terminator-edge", "Where the edge of the terminator goes unnoticed", "[SNY11], [Valve06], their lobes",
         &make_terminator_edge_figure},
    };
    return kFigures;
}

}  // namespace halflit::cli
