#include "bench/peer/gl_target.hpp"

#include <GLES3/gl3.h>

namespace halflit::peer {
namespace {

unsigned framebuffer(int width, int height, int samples, bool depth) {
    GLuint name = 0, buffers[2] = {0, 0};
    glGenFramebuffers(1, &name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glGenRenderbuffers(2, buffers);
    const auto attach = [&](GLuint buffer, GLenum format, GLenum place) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
    };
    attach(buffers[0], GL_SRGB8_ALPHA8, GL_COLOR_ATTACHMENT0);
    if (depth) attach(buffers[1], GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    return name;
}

}  // namespace

bool GlTarget::make(int width, int height, int samples, GlTarget& out, std::string& reason) {
    out.width_ = width, out.height_ = height, out.samples_ = samples;
    if (samples > 1) {
        GLint most = 0;
        glGetIntegerv(GL_MAX_SAMPLES, &most);
        if (most < samples) return reason = "no " + std::to_string(samples) + " samples", false;
        out.resolved_ = framebuffer(width, height, 1, false);
    }
    out.drawn_ = framebuffer(width, height, samples, true);
    if (samples == 1) out.resolved_ = out.drawn_;
    const bool good = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR;
    if (!good) reason = "no sRGB target with float depth";
    return good;
}

void GlTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
    glViewport(0, 0, width_, height_);
}

void GlTarget::finish() const {
    if (samples_ > 1) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
        glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glFinish();
}

void GlTarget::read(std::vector<std::uint8_t>& rgba8) const {
    rgba8.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba8.data());
}

}  // namespace halflit::peer
