// Programs for the OpenGL ES context that is current.
#pragma once

#include <string>

namespace halflit::peer {

/// Compiles and links two shaders; the attribute "position", if there is one, is number 0. Returns the program, or 0 with a reason, such as
/// the compiler's message.
[[nodiscard]] unsigned linked_program(const std::string& vertex_shader, const std::string& fragment_shader, std::string& reason);

}  // namespace halflit::peer
