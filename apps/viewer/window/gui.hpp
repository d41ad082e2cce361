// Dear ImGui in an SDL window: its input from SDL's events, its triangles by SDL's renderer.
#pragma once

#include "apps/viewer/window/sdl.hpp"

struct ImGuiContext;

namespace halflit::viewer {

class Gui {
public:
    /// The renderer must outlive it.
    Gui(const Sdl& sdl, SDL_Renderer* renderer);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void handle(const SDL_Event& event);
    /// Begins a frame of a window of this size; `seconds` after the one before.
    void begin(int width, int height, float seconds);
    /// Ends it and draws it.
    void end();

private:
    void make_font_texture();

    const Sdl& sdl_;
    SDL_Renderer* renderer_;
    SDL_Texture* font_ = nullptr;
    ImGuiContext* context_;
};

}  // namespace halflit::viewer
