// The functions that module/engine.js calls, for the page and the npm package.
#include "apps/web/module.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/web/kernels_apart.hpp"
#include "halflit/image.hpp"

#include <cstdint>
#include <cstdlib>

namespace {

using namespace halflit;
using web::Handle;

std::string of_module;              ///< text that belongs to no scene
Image to_encode;                    ///< the picture that encode() takes
std::vector<std::uint8_t> encoded;  ///< the last file of encode()

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE void* halflit_allocate(int bytes) { return std::malloc(static_cast<std::size_t>(bytes)); }
EMSCRIPTEN_KEEPALIVE void halflit_free(void* memory) { std::free(memory); }

/// Before the first picture: addresses of the tables of kernels that the other module exports.
EMSCRIPTEN_KEEPALIVE void halflit_use_wasm128(const void* raster, const void* shade) { web::use_wasm128(raster, shade); }

/// The instruction set that draws.
EMSCRIPTEN_KEEPALIVE const char* halflit_isa() {
    of_module = default_isa().map([](Isa isa) { return std::string(isa_name(isa)); }).value_or("");
    return of_module.c_str();
}

/// scene: a built-in one, or the name of a file that will be added.
EMSCRIPTEN_KEEPALIVE Handle* halflit_open(const char* scene) {
    auto* const handle = new Handle;
    handle->scene = scene;
    return handle;
}
EMSCRIPTEN_KEEPALIVE void halflit_close(Handle* handle) {
    web::use_files(nullptr);
    delete handle;
}

/// Memory for the file's bytes, which the caller fills. Null: there is none. of_scene: 0 for a file that the model does not name.
EMSCRIPTEN_KEEPALIVE void* halflit_add_file(Handle* handle, const char* name, int size, int of_scene) {
    web::use_files(&handle->files);
    if (of_scene != 0) handle->session.forget_scene();
    try {
        return web::add_file(name, std::vector<std::byte>(static_cast<std::size_t>(size))).data();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

/// Names of files that the last attempt asked for and that are not there, one a line.
EMSCRIPTEN_KEEPALIVE const char* halflit_wanted(Handle* handle) {
    of_module = engine::joined(handle->files.wanted, "\n");
    return of_module.c_str();
}

/// Loads the scene, if the flags (one word a line) need it, without drawing it.
EMSCRIPTEN_KEEPALIVE int halflit_prepare(Handle* handle, const char* flags) {
    return web::attempt_on(*handle, [&] { return handle->session.apply(handle->scene, web::lines_of(flags)); });
}
EMSCRIPTEN_KEEPALIVE int halflit_draw(Handle* handle, const char* flags) {
    return web::attempt_on(*handle, [&] { return handle->session.draw(handle->scene, web::lines_of(flags)); });
}

EMSCRIPTEN_KEEPALIVE const char* halflit_text(Handle* handle) { return handle->text.c_str(); }
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_pixels(Handle* handle) { return handle->session.picture().rgba8.data(); }
EMSCRIPTEN_KEEPALIVE int halflit_width(Handle* handle) { return handle->session.picture().width; }
EMSCRIPTEN_KEEPALIVE int halflit_height(Handle* handle) { return handle->session.picture().height; }

/// The pixels that halflit_encode() takes, RGBA, which the caller fills. Null: there is no memory for them.
EMSCRIPTEN_KEEPALIVE std::uint8_t* halflit_image(int width, int height) {
    try {
        to_encode = {};  // its memory first
        to_encode = Image::make(width, height);
        return to_encode.rgba8.data();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

/// The file of the picture of halflit_image(), which ends there. name: its file's name, whose ending says the format. 0, or the error's
/// exit code, with its words in halflit_module_text().
EMSCRIPTEN_KEEPALIVE int halflit_encode(const char* name) {
    const int failed = web::attempt(of_module, [&]() -> Result<void> {
        const auto format = output_format_of(name);
        if (!format) return tl::unexpected(format.error());
        auto file = encode_image(to_encode, *format);
        if (!file) return tl::unexpected(file.error());
        encoded = std::move(*file);
        return {};
    });
    to_encode = {};
    return failed;
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_encoded() { return encoded.data(); }
EMSCRIPTEN_KEEPALIVE int halflit_encoded_size() { return static_cast<int>(encoded.size()); }
EMSCRIPTEN_KEEPALIVE void halflit_forget_encoded() { encoded = {}; }
EMSCRIPTEN_KEEPALIVE const char* halflit_module_text() { return of_module.c_str(); }

/// " (did you mean NAME?)" if one of the names, one a line, is spelled like the word; otherwise nothing.
EMSCRIPTEN_KEEPALIVE const char* halflit_did_you_mean(const char* word, const char* names) {
    of_module = engine::did_you_mean(word, web::lines_of(names));
    return of_module.c_str();
}

}  // extern "C"
