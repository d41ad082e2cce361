// Stand-ins for what the engine asks its system for and a host of the module does not have. Files are those of dropped_files.cpp.
#include "apps/engine/job/scene_source.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/process.hpp"
#include "apps/io/platform/streams.hpp"

#include <emscripten/heap.h>

#include <cerrno>
#include <cstring>

namespace halflit::platform {

std::string errno_text(int error) { return std::strerror(error); }

std::size_t last_separator(std::string_view path) { return path.rfind('/'); }

int status_of(const std::string& /*path*/, FileStatus& /*status*/) { return ENOENT; }
int status_of(NativeHandle /*handle*/, FileStatus& /*status*/) { return ENOENT; }
std::string whole_path(const std::string& path) { return path; }
std::vector<std::string> names_in(const std::string& /*folder*/, std::size_t /*most*/) { return {}; }
Handle open_to_read(const std::string& /*path*/) { return {}; }
std::ptrdiff_t read_some(NativeHandle /*handle*/, void* /*into*/, std::size_t /*bytes*/) { return -1; }
int close_handle(NativeHandle /*handle*/) { return EBADF; }

bool is_terminal(Stream /*stream*/) { return false; }

std::int64_t peak_memory() { return static_cast<std::int64_t>(emscripten_get_heap_size()); }  // never shrinks

int limit_memory(std::size_t /*bytes*/) { return ENOSYS; }

}  // namespace halflit::platform

namespace halflit::engine {

Result<std::vector<std::byte>> read_standard_input(std::size_t /*max_bytes*/, double /*time_limit_s*/) {
    return fail(ErrorCode::usage, "standard input: a page has none");
}

}  // namespace halflit::engine
