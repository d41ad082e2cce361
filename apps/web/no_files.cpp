// Stand-ins for what the command line asks its system for and a page does not have.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/process.hpp"
#include "apps/io/platform/streams.hpp"

#include <emscripten/heap.h>

#include <cerrno>
#include <cstring>

namespace halflit::platform {

std::string errno_text(int error) { return std::strerror(error); }

std::size_t last_separator(std::string_view path) { return path.rfind('/'); }

bool is_terminal(Stream /*stream*/) { return false; }

std::int64_t peak_memory() { return static_cast<std::int64_t>(emscripten_get_heap_size()); }  // never shrinks

int limit_memory(std::size_t /*bytes*/) { return ENOSYS; }

}  // namespace halflit::platform

namespace halflit::engine {

bool is_file(const std::string& /*path*/) { return false; }

bool is_model_name(std::string_view /*path*/) { return false; }

std::string did_you_mean_file(const std::string& /*path*/, std::vector<std::string> /*names*/) { return ""; }

Result<std::vector<std::byte>> read_standard_input(std::size_t /*max_bytes*/, double /*time_limit_s*/) {
    return fail(ErrorCode::usage, "standard input: a page has none");
}

Result<void> settle_cameras(RenderOptions& options) {
    if (options.camera_file.empty()) return {};
    return fail(ErrorCode::usage, "--camera-file: a page reads no file of cameras");
}

}  // namespace halflit::engine
