// The mouse of a rehearsal: its events go through SDL's queue, as those of the user's mouse do.
#pragma once

#include "apps/viewer/window/sdl.hpp"

namespace halflit::viewer {

class RehearsalMouse {
public:
    explicit RehearsalMouse(const Sdl& sdl) : sdl_(sdl) {}

    /// Events that were pushed and not handled yet.
    [[nodiscard]] bool waits() const { return queued_ > 0; }
    /// Tells that an event is handled. Others' are left alone.
    void handled(const SDL_Event& event) {
        const bool moved = event.type == SDL_MOUSEMOTION && event.motion.which == kMouse;
        const bool pressed = (event.type == SDL_MOUSEBUTTONDOWN || event.type == SDL_MOUSEBUTTONUP) && event.button.which == kMouse;
        if (moved || pressed) --queued_;
    }

    void press(int x, int y) {
        x_ = x, y_ = y;
        push_button(SDL_MOUSEBUTTONDOWN);
    }
    void release() { push_button(SDL_MOUSEBUTTONUP); }
    void drag(int dx) {
        SDL_Event event{};
        event.type = SDL_MOUSEMOTION;
        event.motion.which = kMouse;
        event.motion.x = x_ += dx;
        event.motion.y = y_;
        event.motion.xrel = dx;
        event.motion.state = SDL_BUTTON_LMASK;
        push(event);
    }

private:
    static constexpr Uint32 kMouse = 0x68616e64;  // no mouse of SDL's has this number

    void push_button(Uint32 type) {
        SDL_Event event{};
        event.type = type;
        event.button.which = kMouse;
        event.button.button = SDL_BUTTON_LEFT;
        event.button.x = x_;
        event.button.y = y_;
        push(event);
    }
    void push(SDL_Event& event) {
        if (sdl_.PushEvent(&event) > 0) ++queued_;
    }

    const Sdl& sdl_;
    int x_ = 0, y_ = 0, queued_ = 0;
};

}  // namespace halflit::viewer
