#include "mesa_values.hpp"

#include "mesa_program.hpp"

#include <GLES3/gl3.h>

#include <bit>
#include <cstdint>

namespace halflit::peer {
namespace {

// One triangle that covers the picture.
constexpr const char* kVertexShader = R"(#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
constexpr const char* kBefore = R"(#version 300 es
precision highp float;
precision highp int;
)";
// Floats leave as their bits: OpenGL ES 3.0 draws into integers everywhere, into floats by an extension.
constexpr const char* kAfter = R"(
uniform highp sampler2D arguments;
uniform vec3 sky[9];
out highp uvec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    result = floatBitsToUint(row(at.y, texelFetch(arguments, ivec2(at.x, 0), 0), sky));
}
)";

}  // namespace

std::vector<std::array<float, 4>> shader_values(const std::string& code, std::span<const std::array<float, 4>> arguments, int functions,
                                                std::span<const float> sky, std::string& reason) {
    const GLuint program = linked_program(kVertexShader, kBefore + code + kAfter, reason);
    if (program == 0) return {};
    const auto width = static_cast<GLsizei>(arguments.size()), height = static_cast<GLsizei>(functions);
    GLuint texture = 0, target = 0, framebuffer = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, 1, 0, GL_RGBA, GL_FLOAT, arguments.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenRenderbuffers(1, &target);
    glBindRenderbuffer(GL_RENDERBUFFER, target);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32UI, width, height);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    glViewport(0, 0, width, height);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "arguments"), 0);
    glUniform3fv(glGetUniformLocation(program, "sky"), 9, sky.data());
    glDrawArrays(GL_TRIANGLES, 0, 3);

    std::vector<std::array<std::uint32_t, 4>> bits(arguments.size() * static_cast<std::size_t>(functions));
    glReadPixels(0, 0, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, bits.data());
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteRenderbuffers(1, &target);
    glDeleteTextures(1, &texture);
    if (glGetError() != GL_NO_ERROR) return reason = "an OpenGL error", std::vector<std::array<float, 4>>{};
    std::vector<std::array<float, 4>> values(bits.size());
    for (std::size_t i = 0; i < bits.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) values[i][k] = std::bit_cast<float>(bits[i][k]);
    return values;
}

}  // namespace halflit::peer
