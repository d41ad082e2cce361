// The part of the module for the page: its own short report, comparisons with the reference, and lobes.
#include "apps/web/module.hpp"
#include "apps/web/session_report.hpp"
#include "halflit/lobe.hpp"
#include "sh/order.hpp"

using namespace halflit;
using web::Handle;

namespace {

std::string json;

}  // namespace

extern "C" {

/// As text: the page's report of the last picture or comparison.
EMSCRIPTEN_KEEPALIVE int halflit_page_report(Handle* handle) {
    return web::attempt(handle->text, [&]() -> Result<void> {
        handle->text = handle->session.report();
        return {};
    });
}

/// The picture's error against --accuracy reference, as PictureSession::compare() draws it.
EMSCRIPTEN_KEEPALIVE int halflit_compare(Handle* handle, const char* flags) {
    return web::attempt_on(*handle, [&] { return handle->session.compare(handle->scene, web::lines_of(flags)); });
}

/// JSON of a lobe: its curve and its bands.
EMSCRIPTEN_KEEPALIVE const char* halflit_lobe(float wrap, float power, int normalize, int bands) {
    const Lobe lobe{wrap, power, normalize != 0};
    const auto checked = check_lobe(lobe);
    json = checked ? web::lobe_report(lobe, std::clamp(bands, 1, sh::kMaxBands), 181)
                   : "{\"error\":" + web::json_text(checked.error().message) + "}";
    return json.c_str();
}

/// JSON of the tables that the page's own code needs, for assemble.mjs.
EMSCRIPTEN_KEEPALIVE const char* halflit_tables() {
    json = web::table_report();
    return json.c_str();
}

}  // extern "C"
