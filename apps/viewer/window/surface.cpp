#include "apps/viewer/window/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::viewer {

Surface::~Surface() {
    if (picture != nullptr) sdl.DestroyTexture(picture);
    if (renderer != nullptr) sdl.DestroyRenderer(renderer);
    if (window != nullptr) sdl.DestroyWindow(window);
}

Result<void> Surface::open(const std::string& title, int width, int height) {
    const auto failed = [this](const std::string& what) { return fail(ErrorCode::usage, "view: " + what + ": " + sdl.GetError()); };
    window = sdl.CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height, SDL_WINDOW_RESIZABLE);
    if (window == nullptr) return failed("no window");
    renderer = sdl.CreateRenderer(window, -1, 0);
    if (renderer == nullptr) return failed("nothing draws into the window");
    return {};
}

void Surface::show(const Image& image) {
    if (picture == nullptr || picture_width_ != image.width || picture_height_ != image.height) {
        if (picture != nullptr) sdl.DestroyTexture(picture);
        picture = sdl.CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, image.width, image.height);
        picture_width_ = image.width, picture_height_ = image.height;
        if (picture == nullptr) return;
        sdl.SetTextureBlendMode(picture, SDL_BLENDMODE_NONE);
    }
    sdl.UpdateTexture(picture, nullptr, image.rgba8.data(), image.width * 4);
}

Image Surface::screenshot(int width, int height) const {
    Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4), {}};
    sdl.RenderReadPixels(renderer, nullptr, SDL_PIXELFORMAT_RGBA32, image.rgba8.data(), width * 4);
    for (std::size_t i = 3; i < image.rgba8.size(); i += 4) image.rgba8[i] = 255;  // a window is opaque
    return image;
}

}  // namespace halflit::viewer
