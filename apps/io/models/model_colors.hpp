// Colours as files of models have them, made linear light.
#pragma once

#include "halflit/math.hpp"
#include "halflit/model.hpp"

#include <span>

namespace halflit::io::detail {

/// The number that stands for 1 among colours whose format does not fix it: 255 or 65535 where the largest channel is beyond what shares
/// have (2: rounding, and light of high range, may exceed 1), or where all are whole numbers, as sRGB codes are.
[[nodiscard]] double unit_of_colors(std::span<const Vec4f> colors, bool are_whole);
/// Makes linear light of red, green and blue in sRGB, where `unit` stands for 1. Channels that are not finite make the colour white.
void make_linear(std::span<Vec4f> colors, double unit);
/// True if there are colours, all are one, and writers of the format mean by it that there is none (writer_habits.hpp).
[[nodiscard]] bool are_no_colors(ModelFormat format, std::span<const Vec4f> linear);

/// The map viridis, by a value from 0 to 1, in linear light.
[[nodiscard]] Vec4f viridis(double t);
/// A colour for a class or an object, by its number: neighbours differ well. 0 and below, and not a number, are grey.
[[nodiscard]] Vec4f label_color(double label);

}  // namespace halflit::io::detail
