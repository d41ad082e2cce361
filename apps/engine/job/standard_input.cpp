#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/handles.hpp"
#include "apps/io/platform/streams.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <cmath>

namespace halflit::engine {
namespace {

/// Waits until standard input has something to read or has ended. time_limit_s: from `waiting` on; 0: none.
Result<void> wait_for_input(const Stopwatch& waiting, double time_limit_s) {
    for (;;) {
        const double left_ms = time_limit_s > 0.0 ? std::ceil(time_limit_s * 1000.0 - waiting.ms()) : -1.0;
        if (time_limit_s > 0.0 && left_ms <= 0.0)
            return fail(ErrorCode::limit, fmt::format("{}: took more than {} s (--timeout)", kStandardInputName, time_limit_s));
        if (platform::wait_for_input(left_ms)) return {};
    }
}

}  // namespace

Result<std::vector<std::byte>> read_standard_input(std::size_t max_bytes, double time_limit_s) {
    if (platform::is_terminal(platform::Stream::input)) return fail(ErrorCode::usage, "standard input: expected a model, found a terminal");
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    const Stopwatch reading;
    std::vector<std::byte> bytes;
    for (;;) {
        if (const auto waited = wait_for_input(reading, time_limit_s); !waited) return tl::unexpected(waited.error());
        const std::size_t size = bytes.size();
        if (size > max_bytes)
            return fail(ErrorCode::limit, fmt::format("{}: more than {} bytes (--max-file-bytes)", kStandardInputName, max_bytes));
        bytes.resize(size + kChunk);
        const std::ptrdiff_t got = platform::read_some(platform::standard_input(), bytes.data() + size, kChunk);
        const int error = errno;
        bytes.resize(size + (got > 0 ? static_cast<std::size_t>(got) : 0));
        if (got == 0) return bytes;
        if (got < 0) return fail(ErrorCode::io, fmt::format("{}: {}", kStandardInputName, platform::errno_text(error)));
    }
}

}  // namespace halflit::engine
