// JPEG and WebP pictures, which the browser decodes. That takes place between two attempts to load a model: the first one notes which
// pictures it wants, and fails; the page has them decoded, hands them over, and asks again. A build with the libraries of libraries.cmake
// decodes them itself, and wants none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halflit::web {

/// Pictures that were asked for and not handed over, as the files have them.
[[nodiscard]] const std::vector<std::vector<std::byte>>& wanted_pictures();

/// Hands over the pixels of wanted_pictures()[index]: RGBA, not premultiplied. Width 0: the browser cannot decode it. The indices stay.
void give_picture(std::size_t index, int width, int height, std::vector<std::uint8_t> rgba8);

/// Empties the list of wanted pictures. Those that were handed over stay.
void forget_wanted_pictures();
void forget_given_pictures();

}  // namespace halflit::web
