#include "mesa_ids.hpp"

#include "mesa_program.hpp"

#include <GLES3/gl3.h>

namespace halflit::peer {

namespace {

// y is negated (an exact operation), because row 0 of an off-screen target is its lowest row. The picture in memory then has row 0 on top,
// with the top-left rule as seen in memory.
constexpr const char* kVertexShader = R"(#version 300 es
in highp vec4 position;
flat out highp uint id;
void main() {
    gl_Position = vec4(position.x, -position.y, position.z, position.w);
    id = uint(gl_VertexID / 3) + 1u;
}
)";

constexpr const char* kFragmentShader = R"(#version 300 es
flat in highp uint id;
out highp uint result;
void main() { result = id; }
)";

}  // namespace

std::unique_ptr<Mesa> Mesa::create(std::string& reason) {
    std::unique_ptr<Mesa> mesa(new Mesa);
    mesa->context_ = MesaContext::create(reason);
    if (mesa->context_ == nullptr) return nullptr;
    mesa->program_ = linked_program(kVertexShader, kFragmentShader, reason);
    if (mesa->program_ == 0) return nullptr;
    return mesa;
}

std::vector<std::uint32_t> Mesa::ids(int width, int height, std::span<const Vec4f> clip_positions) {
    GLuint target = 0, framebuffer = 0, buffer = 0;
    glGenRenderbuffers(1, &target);
    glBindRenderbuffer(GL_RENDERBUFFER, target);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_R32UI, width, height);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);

    constexpr GLuint kNothing[4] = {0, 0, 0, 0};
    glViewport(0, 0, width, height);
    glClearBufferuiv(GL_COLOR, 0, kNothing);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DITHER);
    glUseProgram(program_);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(clip_positions.size_bytes()), clip_positions.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Vec4f), nullptr);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(clip_positions.size()));

    // Four channels: the one format that every implementation reads from an unsigned integer target.
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<std::uint32_t> rgba(4 * pixels), ids(pixels);
    glReadPixels(0, 0, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, rgba.data());
    for (std::size_t i = 0; i < pixels; ++i) ids[i] = rgba[4 * i];

    glDeleteBuffers(1, &buffer);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteRenderbuffers(1, &target);
    return glGetError() == GL_NO_ERROR ? ids : std::vector<std::uint32_t>{};
}

}  // namespace halflit::peer
