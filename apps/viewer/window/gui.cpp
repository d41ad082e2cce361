#include "apps/viewer/window/gui.hpp"

#include <imgui.h>

#include <algorithm>
#include <iterator>

namespace halflit::viewer {
namespace {

struct Key {
    ImGuiKey gui;
    SDL_Scancode sdl;
};
/// Keys of text fields: a slider becomes one with Ctrl and a click.
constexpr Key kKeys[] = {{ImGuiKey_Tab, SDL_SCANCODE_TAB},
                         {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
                         {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
                         {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
                         {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
                         {ImGuiKey_Home, SDL_SCANCODE_HOME},
                         {ImGuiKey_End, SDL_SCANCODE_END},
                         {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
                         {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
                         {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
                         {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
                         {ImGuiKey_A, SDL_SCANCODE_A},
                         {ImGuiKey_C, SDL_SCANCODE_C},
                         {ImGuiKey_V, SDL_SCANCODE_V},
                         {ImGuiKey_X, SDL_SCANCODE_X}};

int button_of(Uint8 button) { return button == SDL_BUTTON_LEFT ? 0 : button == SDL_BUTTON_RIGHT ? 1 : 2; }

#if IMGUI_VERSION_NUM >= 18700
void move_mouse(ImGuiIO& io, int x, int y) { io.AddMousePosEvent(static_cast<float>(x), static_cast<float>(y)); }
void press_mouse(ImGuiIO& io, int button, bool down) { io.AddMouseButtonEvent(button, down); }
void turn_wheel(ImGuiIO& io, int x, int y) { io.AddMouseWheelEvent(static_cast<float>(x), static_cast<float>(y)); }
void press_key(ImGuiIO& io, const SDL_KeyboardEvent& key, bool down) {
    io.AddKeyEvent(ImGuiMod_Ctrl, (key.keysym.mod & KMOD_CTRL) != 0);
    io.AddKeyEvent(ImGuiMod_Shift, (key.keysym.mod & KMOD_SHIFT) != 0);
    for (const Key& known : kKeys)
        if (known.sdl == key.keysym.scancode) io.AddKeyEvent(known.gui, down);
}
void map_keys(ImGuiIO&) {}
#else
void move_mouse(ImGuiIO& io, int x, int y) { io.MousePos = {static_cast<float>(x), static_cast<float>(y)}; }
void press_mouse(ImGuiIO& io, int button, bool down) { io.MouseDown[button] = down; }
void turn_wheel(ImGuiIO& io, int x, int y) {
    io.MouseWheelH += static_cast<float>(x);
    io.MouseWheel += static_cast<float>(y);
}
void press_key(ImGuiIO& io, const SDL_KeyboardEvent& key, bool down) {
    if (key.keysym.scancode < static_cast<int>(std::size(io.KeysDown))) io.KeysDown[key.keysym.scancode] = down;
    io.KeyCtrl = (key.keysym.mod & KMOD_CTRL) != 0;
    io.KeyShift = (key.keysym.mod & KMOD_SHIFT) != 0;
}
void map_keys(ImGuiIO& io) {
    for (const Key& key : kKeys) io.KeyMap[key.gui] = key.sdl;
}
#endif

}  // namespace

Gui::Gui(const Sdl& sdl, SDL_Renderer* renderer) : sdl_(sdl), renderer_(renderer), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGui::StyleColorsDark();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is written into the folder
    io.LogFilename = nullptr;
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0f;
    style.FramePadding = {4.0f, 1.0f};
    style.ItemSpacing = {6.0f, 3.0f};
    style.AntiAliasedFill = false;  // fewer triangles, which the processor draws
    style.AntiAliasedLines = false;
    map_keys(io);
    make_font_texture();
}

Gui::~Gui() {
    if (font_ != nullptr) sdl_.DestroyTexture(font_);
    ImGui::DestroyContext(context_);
}

void Gui::make_font_texture() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    font_ = sdl_.CreateTexture(renderer_, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
    if (font_ == nullptr) return;
    sdl_.UpdateTexture(font_, nullptr, pixels, width * 4);
    sdl_.SetTextureBlendMode(font_, SDL_BLENDMODE_BLEND);
    io.Fonts->SetTexID(reinterpret_cast<ImTextureID>(font_));
}

void Gui::handle(const SDL_Event& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.type) {
        case SDL_MOUSEMOTION:
            move_mouse(io, event.motion.x, event.motion.y);
            break;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            move_mouse(io, event.button.x, event.button.y);
            press_mouse(io, button_of(event.button.button), event.type == SDL_MOUSEBUTTONDOWN);
            break;
        case SDL_MOUSEWHEEL:
            turn_wheel(io, event.wheel.x, event.wheel.y);
            break;
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            press_key(io, event.key, event.type == SDL_KEYDOWN);
            break;
        case SDL_TEXTINPUT:
            io.AddInputCharactersUTF8(event.text.text);
            break;
        default:
            break;
    }
}

void Gui::begin(int width, int height, float seconds) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = std::max(seconds, 1e-4f);
    ImGui::NewFrame();
}

void Gui::end() {
    ImGui::Render();
    const ImDrawData* const data = ImGui::GetDrawData();
    for (int n = 0; n < data->CmdListsCount; ++n) {
        const ImDrawList& list = *data->CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.UserCallback != nullptr) continue;
            const SDL_Rect clip{static_cast<int>(command.ClipRect.x), static_cast<int>(command.ClipRect.y),
                                static_cast<int>(command.ClipRect.z - command.ClipRect.x),
                                static_cast<int>(command.ClipRect.w - command.ClipRect.y)};
            if (clip.w <= 0 || clip.h <= 0) continue;
            sdl_.RenderSetClipRect(renderer_, &clip);
            const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
            sdl_.RenderGeometryRaw(renderer_, reinterpret_cast<SDL_Texture*>(command.GetTexID()), &vertices->pos.x, sizeof(ImDrawVert),
                                   reinterpret_cast<const SDL_Color*>(&vertices->col), sizeof(ImDrawVert), &vertices->uv.x,
                                   sizeof(ImDrawVert), list.VtxBuffer.Size - static_cast<int>(command.VtxOffset),
                                   list.IdxBuffer.Data + command.IdxOffset, static_cast<int>(command.ElemCount), sizeof(ImDrawIdx));
        }
    }
    sdl_.RenderSetClipRect(renderer_, nullptr);
}

}  // namespace halflit::viewer
