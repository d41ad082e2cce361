// Colours as files of models have them, made linear light.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "apps/io/models/soup.hpp"
#include "halflit/math.hpp"
#include "halflit/model.hpp"

#include <span>

namespace halflit::io::detail {

/// Makes linear light of sRGB where the format does not say whether 1, 255 or 65535 is full intensity. 1 if not all values are integers by
/// their type, and no channel exceeds 2 or most of those above 0 are fractions below 2, as of HDR. Warns of fractions above 2, which leave
/// a doubt, and of colours that are not finite.
void make_linear_by_range(std::span<Vec4f> colors, bool are_whole, Document& document);
/// Makes linear light of red, green and blue in sRGB, where `unit` stands for 1. Channels that are not finite make the colour white.
void make_linear(std::span<Vec4f> colors, double unit);
/// Clears the colours, in linear light, if all are one, and writers of the format mean by it that there is none (writer_habits.hpp); warns
/// of it. Returns whether it did.
bool drop_no_colors(ModelFormat format, Soup& soup, Document& document);

/// The map viridis, by a value from 0 to 1, in linear light.
[[nodiscard]] Vec4f viridis(double t);
/// A colour for a class or an object, by its number: neighbours differ well. 0 and below, and not a number, are grey.
[[nodiscard]] Vec4f label_color(double label);

}  // namespace halflit::io::detail
