#include "apps/viewer/window/sdl.hpp"

#include <dlfcn.h>

#include <string>

namespace halflit::viewer {

Result<Sdl> load_sdl() {
#ifdef __APPLE__
    constexpr const char* kLibrary = "libSDL2-2.0.0.dylib";
#else
    constexpr const char* kLibrary = "libSDL2-2.0.so.0";
#endif
    void* const library = ::dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
        return fail(ErrorCode::usage, std::string("view: needs the library SDL2 (") + kLibrary + ", in Debian's package libsdl2-2.0-0)");
    Sdl sdl;
    const char* missing = nullptr;
#define HALFLIT_SDL_LOAD(name)                                                       \
    sdl.name = reinterpret_cast<decltype(sdl.name)>(::dlsym(library, "SDL_" #name)); \
    if (sdl.name == nullptr) missing = "SDL_" #name;
    HALFLIT_SDL_FUNCTIONS(HALFLIT_SDL_LOAD)
#undef HALFLIT_SDL_LOAD
    if (missing != nullptr) return fail(ErrorCode::usage, std::string("view: SDL2 is too old: it has no ") + missing);
    return sdl;
}

}  // namespace halflit::viewer
