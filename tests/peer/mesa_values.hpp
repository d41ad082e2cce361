// Values of GLSL functions, computed by the OpenGL ES context that Mesa::create made current.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace halflit::peer {

/// Runs `code`, GLSL ES 3.00 that defines vec4 row(int function, vec4 arguments, vec3 sky[9]), for every function and every argument.
/// Returns rows of values, one row for each function; empty with a reason (the compiler's message) when it cannot. At most 16384 arguments.
[[nodiscard]] std::vector<std::array<float, 4>> shader_values(const std::string& code, std::span<const std::array<float, 4>> arguments,
                                                              int functions, std::span<const float> sky, std::string& reason);

}  // namespace halflit::peer
