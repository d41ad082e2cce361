// SDL2, loaded when a window is asked for: the program itself depends on no library of windows, and starts as fast as without one.
#pragma once

#include "halflit/error.hpp"

#define SDL_MAIN_HANDLED
#include <SDL.h>

namespace halflit::viewer {

#define HALFLIT_SDL_FUNCTIONS(F) \
    F(Init)                      \
    F(Quit)                      \
    F(SetHint)                   \
    F(GetError)                  \
    F(GetCurrentVideoDriver)     \
    F(CreateWindow)              \
    F(DestroyWindow)             \
    F(GetWindowSize)             \
    F(CreateRenderer)            \
    F(DestroyRenderer)           \
    F(CreateTexture)             \
    F(DestroyTexture)            \
    F(UpdateTexture)             \
    F(SetTextureBlendMode)       \
    F(SetTextureScaleMode)       \
    F(SetRenderDrawColor)        \
    F(RenderClear)               \
    F(RenderCopy)                \
    F(RenderSetClipRect)         \
    F(RenderGeometryRaw)         \
    F(RenderReadPixels)          \
    F(RenderPresent)             \
    F(PollEvent)                 \
    F(WaitEventTimeout)          \
    F(PushEvent)                 \
    F(StartTextInput)            \
    F(GetClipboardText)          \
    F(SetClipboardText)          \
    F(free)

/// SDL's functions, without their prefix.
struct Sdl {
#define HALFLIT_SDL_MEMBER(name) decltype(&::SDL_##name) name = nullptr;
    HALFLIT_SDL_FUNCTIONS(HALFLIT_SDL_MEMBER)
#undef HALFLIT_SDL_MEMBER
};

/// Fails (usage) where the library or a function of it is missing. It stays loaded.
[[nodiscard]] Result<Sdl> load_sdl();

}  // namespace halflit::viewer
