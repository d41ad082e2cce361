// Draws a model as a host does, with the public interface alone. Compiled twice: with the project's flags, and with -Ofast.
#pragma once

#include <cstdint>
#include <string>

namespace halflit::test {

/// Hash of the picture of a model, 96 x 96 pixels, and of some matrices and shapes; 0 if it is not drawn.
std::uint64_t picture_of_usual_host(const std::string& path);
std::uint64_t picture_of_fast_host(const std::string& path);

}  // namespace halflit::test
