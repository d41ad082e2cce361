#include "bench/peer/gl_target.hpp"

#include <GLES3/gl3.h>

#include <limits>

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

void wait_until_drawn() { glFinish(); }

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

void GlTarget::begin() const {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
    glViewport(0, 0, width_, height_);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 1);
    glClearDepthf(1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void GlTarget::resolve() const {
    if (samples_ == 1) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void GlTarget::read(std::vector<std::uint8_t>& rgba8) const {
    rgba8.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba8.data());
}

bool GlPlanes::make(int width, int height, bool with_colour, GlPlanes& out, std::string& reason) {
    out.width_ = width, out.height_ = height, out.with_colour_ = with_colour;
    glGenFramebuffers(1, &out.name_);
    glBindFramebuffer(GL_FRAMEBUFFER, out.name_);
    const auto attach = [&](GLenum format, GLenum place) {
        GLuint buffer = 0;
        glGenRenderbuffers(1, &buffer);
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
    };
    if (with_colour) attach(GL_SRGB8_ALPHA8, GL_COLOR_ATTACHMENT0);
    attach(GL_R32UI, GL_COLOR_ATTACHMENT1);
    attach(GL_R32F, GL_COLOR_ATTACHMENT2);
    attach(GL_RG32F, GL_COLOR_ATTACHMENT3);
    attach(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    const GLenum places[] = {static_cast<GLenum>(with_colour ? GL_COLOR_ATTACHMENT0 : GL_NONE), GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                             GL_COLOR_ATTACHMENT3};
    glDrawBuffers(4, places);
    const bool good = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR;
    if (!good) reason = "no target with planes of floats and whole numbers";
    return good;
}

void GlPlanes::begin() const {
    constexpr GLfloat kBlack[] = {0, 0, 0, 1}, kInfinity[] = {std::numeric_limits<float>::infinity(), 0, 0, 0}, kFar[] = {1},
                      kNoWeights[] = {0, 0, 0, 0};
    constexpr GLuint kNothing[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    glViewport(0, 0, width_, height_);
    glDepthMask(GL_TRUE);
    if (with_colour_) glClearBufferfv(GL_COLOR, 0, kBlack);
    glClearBufferuiv(GL_COLOR, 1, kNothing);
    glClearBufferfv(GL_COLOR, 2, kInfinity);
    glClearBufferfv(GL_COLOR, 3, kNoWeights);
    glClearBufferfv(GL_DEPTH, 0, kFar);
}

void GlPlanes::read(Planes& planes) const {
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const auto read = [&](GLenum place, GLenum format, GLenum type, void* values) {
        glReadBuffer(place);
        glReadPixels(0, 0, width_, height_, format, type, values);
    };
    if (with_colour_) read(GL_COLOR_ATTACHMENT0, GL_RGBA, GL_UNSIGNED_BYTE, planes.rgba8.data());
    read(GL_COLOR_ATTACHMENT1, GL_RED_INTEGER, GL_UNSIGNED_INT, planes.triangle.data());
    read(GL_COLOR_ATTACHMENT2, GL_RED, GL_FLOAT, planes.depth.data());
    read(GL_COLOR_ATTACHMENT3, GL_RG, GL_FLOAT, planes.barycentric.data());
}

}  // namespace halflit::peer
