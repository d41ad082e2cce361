#include "mesa_program.hpp"

#include <GLES3/gl3.h>

namespace halflit::peer {
namespace {

/// 0 with a reason when the source is not valid.
GLuint compiled(GLenum type, const std::string& source, std::string& reason) {
    const GLuint shader = glCreateShader(type);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good != 0) return shader;
    char log[2000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    reason = log;
    return 0;
}

}  // namespace

unsigned linked_program(const std::string& vertex_shader, const std::string& fragment_shader, std::string& reason) {
    const GLuint vertex = compiled(GL_VERTEX_SHADER, vertex_shader, reason);
    const GLuint fragment = compiled(GL_FRAGMENT_SHADER, fragment_shader, reason);
    if (vertex == 0 || fragment == 0) return 0;
    const GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glBindAttribLocation(program, 0, "position");
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) reason = "the shaders do not link";
    return linked != 0 ? program : 0;
}

}  // namespace halflit::peer
