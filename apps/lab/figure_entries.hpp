// Functions that make the figures; figure_entries.cpp lists them with their names and sources.
#pragma once

#include "apps/lab/figure.hpp"

namespace halflit::cli {

// figure_curves.cpp: curves without pictures
[[nodiscard]] Result<Figure> make_curves_figure();
[[nodiscard]] Result<Figure> make_sh_error_figure();
[[nodiscard]] Result<Figure> make_band_energy_figure();

// figure_lobes.cpp: the wrap family on a sphere and on a bust
[[nodiscard]] Result<Figure> make_wrap_form_figure();
[[nodiscard]] Result<Figure> make_backlight_figure();
[[nodiscard]] Result<Figure> make_green_sloan_figure();
[[nodiscard]] Result<Figure> make_normalized_figure();
[[nodiscard]] Result<Figure> make_half_lambert_figure();

// figure_area_light.cpp: a sphere of light beside one wrapped light
[[nodiscard]] Result<Figure> make_area_light_figure();

// figure_gamma.cpp: half-Lambert before and after linear light
[[nodiscard]] Result<Figure> make_gamma_figure();

// figure_shading.cpp: shading rates and light sources
[[nodiscard]] Result<Figure> make_shading_rates_figure();
[[nodiscard]] Result<Figure> make_light_sources_figure();

// figure_highlights.cpp: Phong against Blinn, with and without N.L
[[nodiscard]] Result<Figure> make_highlights_figure();

// figure_terminator.cpp: shadows and wrapped light
[[nodiscard]] Result<Figure> make_terminator_figure();

// figure_terminator_edge.cpp: many lights and an environment over the terminator
[[nodiscard]] Result<Figure> make_terminator_edge_figure();

}  // namespace halflit::cli
