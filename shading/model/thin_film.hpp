// Interference in a thin film [BB17], as KHR_materials_iridescence has it.
//
// Light that crosses the film of the index n and the thickness d m times more than light that its outer side reflects has a way that is m
// 2 n d cos longer. The share of a colour channel that this leaves is a sum of four waves:
//
//     S(way) = sum of rgb cos(2 pi waves way) 2^(-fade way^2)        way in nanometres
//
// They are fits to the CIE curves, in linear sRGB.
#pragma once

namespace halflit::shading {

struct FilmWave {
    float waves_per_nm, fade_per_nm2;
    float rgb[3];
};
constexpr FilmWave kFilmWaves[] = {{1.6810e-3f, 2.464912e-7f, {2.743336f, -0.8205709f, 0.04710715f}},
                                   {1.7953e-3f, 5.299464e-7f, {-1.5374796f, 1.8764271f, -0.20407117f}},
                                   {2.2084e-3f, 3.765943e-7f, {-0.49909099f, 0.041602647f, 1.0584119f}},
                                   {2.2399e-3f, 2.579051e-7f, {0.4986032f, -0.14913932f, 0.0085617557f}}};
/// A longer way counts as this: the waves are 1e-29 there.
inline constexpr float kMostFilmWay = 2e4f;
/// Limits of the index, and of the thickness. Thicker films have no colours.
inline constexpr float kMostFilmIor = 100.0f, kMostFilmNm = 1e5f;
/// A thinner film covers less of the surface, in proportion: one without a thickness is none. (The extension lets the index fall to 1, so
/// that Schlick's curve still reflects light at a side that is not there.)
inline constexpr float kThinFilmNm = 0.03f;
/// N.V counts from here: at grazing views all is mirrored, and F0 has no meaning.
inline constexpr float kLeastFilmCosine = 0.1f;
/// The sign of the amplitude that the inner side reflects is smooth where that is less than the inverse of this.
inline constexpr float kFilmSignSlope = 64.0f;

}  // namespace halflit::shading
