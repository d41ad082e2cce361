#include "mesa_ids.hpp"

#include "mesa_program.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <cstdlib>

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
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    std::unique_ptr<Mesa> mesa(new Mesa);

    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get_display == nullptr) return reason = "EGL has no platform displays", nullptr;
    mesa->display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (mesa->display_ == EGL_NO_DISPLAY || !eglInitialize(mesa->display_, nullptr, nullptr)) {
        mesa->display_ = nullptr;
        return reason = "EGL has no surfaceless display", nullptr;
    }
    constexpr EGLint kConfig[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    constexpr EGLint kContext[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglBindAPI(EGL_OPENGL_ES_API) || !eglChooseConfig(mesa->display_, kConfig, &config, 1, &count) || count == 0)
        return reason = "EGL offers no OpenGL ES 3", nullptr;
    mesa->context_ = eglCreateContext(mesa->display_, config, EGL_NO_CONTEXT, kContext);
    if (mesa->context_ == EGL_NO_CONTEXT || !eglMakeCurrent(mesa->display_, EGL_NO_SURFACE, EGL_NO_SURFACE, mesa->context_))
        return reason = "no OpenGL ES 3 context", nullptr;

    mesa->renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (mesa->renderer_.find("llvmpipe") == std::string::npos) return reason = "the renderer is " + mesa->renderer_, nullptr;

    mesa->program_ = linked_program(kVertexShader, kFragmentShader, reason);
    if (mesa->program_ == 0) return nullptr;
    return mesa;
}

Mesa::~Mesa() {
    if (display_ == nullptr) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglTerminate(display_);
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
