#include "mesa_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <cstdlib>

namespace halflit::peer {

std::unique_ptr<MesaContext> MesaContext::create(std::string& reason) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    std::unique_ptr<MesaContext> mesa(new MesaContext);

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
    return mesa;
}

MesaContext::~MesaContext() {
    if (display_ == nullptr) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglTerminate(display_);
}

}  // namespace halflit::peer
