// The functions that the page's worker calls. Texts are UTF-8 and end with a zero byte; a text that is returned lives until the next call.
#include "apps/web/browser_pictures.hpp"
#include "apps/web/dropped_files.hpp"
#include "apps/web/kernels_apart.hpp"
#include "apps/web/picture_session.hpp"
#include "apps/web/session_report.hpp"
#include "halflit/lobe.hpp"
#include "sh/order.hpp"

#include <emscripten.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

namespace {

using namespace halflit;

web::PictureSession& session() {
    static web::PictureSession one;
    return one;
}

std::string message;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

/// 0, or the error's exit code, with its words in halflit_message().
template <class Work>
int attempt(const Work& work) {
    web::forget_wanted_pictures();
    Result<void> done;
    try {
        done = work();
    } catch (const std::bad_alloc&) {
        done = fail(ErrorCode::limit, "out of memory");
    }
    message = done ? "" : done.error().message;
    return done ? 0 : std::max(1, static_cast<int>(done.error().code));
}

std::vector<std::byte> bytes_at(const void* data, int size) {
    const auto* const first = static_cast<const std::byte*>(data);
    return {first, first + size};
}

}  // namespace

extern "C" {

/// Memory for what the page hands over.
EMSCRIPTEN_KEEPALIVE void* halflit_allocate(int bytes) { return std::malloc(static_cast<std::size_t>(bytes)); }
EMSCRIPTEN_KEEPALIVE void halflit_free(void* memory) { std::free(memory); }

/// Before the first picture: addresses of the tables of kernels that the other module exports.
EMSCRIPTEN_KEEPALIVE void halflit_use_wasm128(const void* raster, const void* shade) { web::use_wasm128(raster, shade); }

/// flags: one word a line.
EMSCRIPTEN_KEEPALIVE int halflit_draw(const char* scene, const char* flags) {
    return attempt([&] { return session().draw(scene, lines_of(flags)); });
}
EMSCRIPTEN_KEEPALIVE int halflit_compare(const char* scene, const char* flags) {
    return attempt([&] { return session().compare(scene, lines_of(flags)); });
}
EMSCRIPTEN_KEEPALIVE const char* halflit_message() { return message.c_str(); }
EMSCRIPTEN_KEEPALIVE const char* halflit_report() {
    message = session().report();
    return message.c_str();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* halflit_pixels() { return session().picture().rgba8.data(); }
EMSCRIPTEN_KEEPALIVE int halflit_width() { return session().picture().width; }
EMSCRIPTEN_KEEPALIVE int halflit_height() { return session().picture().height; }

/// JSON of a lobe: its curve and its bands.
EMSCRIPTEN_KEEPALIVE const char* halflit_lobe(float wrap, float power, int normalize, int bands) {
    const Lobe lobe{wrap, power, normalize != 0};
    const auto checked = check_lobe(lobe);
    message = checked ? web::lobe_report(lobe, std::clamp(bands, 1, sh::kMaxBands), 181)
                      : "{\"error\":" + web::json_text(checked.error().message) + "}";
    return message.c_str();
}
/// JSON of the tables that the page's own code needs, for assemble.mjs.
EMSCRIPTEN_KEEPALIVE const char* halflit_tables() {
    message = web::table_report();
    return message.c_str();
}

EMSCRIPTEN_KEEPALIVE void halflit_add_file(const char* name, const void* data, int size) {
    web::add_file(name, bytes_at(data, size));
    session().forget_scene();
}
EMSCRIPTEN_KEEPALIVE void halflit_forget_files() {
    web::forget_files();
    web::forget_given_pictures();
    session().forget_scene();
}

/// Pictures that the last attempt lacked, for the browser to decode.
EMSCRIPTEN_KEEPALIVE int halflit_wanted_count() { return static_cast<int>(web::wanted_pictures().size()); }
EMSCRIPTEN_KEEPALIVE const void* halflit_wanted(int index) { return web::wanted_pictures()[static_cast<std::size_t>(index)].data(); }
EMSCRIPTEN_KEEPALIVE int halflit_wanted_size(int index) {
    return static_cast<int>(web::wanted_pictures()[static_cast<std::size_t>(index)].size());
}
EMSCRIPTEN_KEEPALIVE void halflit_give_picture(int index, int width, int height, const std::uint8_t* rgba8) {
    const auto bytes = std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    web::give_picture(static_cast<std::size_t>(index), width, height, {rgba8, rgba8 + bytes});
}

}  // extern "C"
