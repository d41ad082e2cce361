// An SDL window and what is drawn into it besides the panel.
#pragma once

#include "apps/viewer/window/sdl.hpp"
#include "halflit/target.hpp"

#include <string>

namespace halflit::viewer {

struct Surface {
    const Sdl& sdl;
    SDL_Window* window = nullptr;
    SDL_Renderer* renderer = nullptr;
    SDL_Texture* picture = nullptr;  ///< null: none was shown yet

    explicit Surface(const Sdl& loaded) : sdl(loaded) {}
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    [[nodiscard]] Result<void> open(const std::string& title, int width, int height);
    /// The picture from now on.
    void show(const Image& image);
    /// The picture drawn since the last presenting.
    [[nodiscard]] Image screenshot(int width, int height) const;

private:
    int picture_width_ = 0, picture_height_ = 0;  ///< of the texture
};

}  // namespace halflit::viewer
