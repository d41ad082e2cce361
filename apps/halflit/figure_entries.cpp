#include "apps/halflit/figure_entries.hpp"

namespace halflit::cli {

std::span<const FigureEntry> all_figures() {
    static constexpr FigureEntry kFigures[] = {
        {"wrap-form", "Wrap on a form that is lit from the side and behind", "[SNY11] fig. 1", &make_wrap_form_figure},
        {"backlight", "Two lobes that wrap all the way, with a light behind", "[SNY11] fig. 2; [Green04], [Valve06]",
         &make_backlight_figure},
        {"curves", "The lobes over the angle", "[SNY11] fig. 3 and eq. 3", &make_curves_figure},
        {"green-sloan", "Green's lobe above Sloan's at the same wrap", "[SNY11] fig. 4", &make_green_sloan_figure},
        {"sh-error", "What order-3 spherical harmonics lose of the lobe", "[SNY11] fig. 5", &make_sh_error_figure},
        {"band-energy", "Where the lobe's energy is, band by band", "[SNY11] fig. 6", &make_band_energy_figure},
        {"normalized", "Wrapped light, as it is and normalised", "[McA13], before and after", &make_normalized_figure},
        {"half-lambert", "Lambert, half-Lambert and its square", "[Lis]; [Valve06]", &make_half_lambert_figure},
        {"shading-rates", "Light once a triangle, once a vertex, once a pixel", "[CMSC], shading strategies", &make_shading_rates_figure},
        {"highlights", "Phong's highlight and Blinn's", "[CMSC], Phong model and Blinn model", &make_highlights_figure},
        {"light-sources", "Directional, point and spot light", "[CMSC], light sources", &make_light_sources_figure},
        {"terminator", "Shadow maps and wrapped light at the terminator", "[SNY11] sec. 3", &make_terminator_figure},
    };
    return kFigures;
}

}  // namespace halflit::cli
