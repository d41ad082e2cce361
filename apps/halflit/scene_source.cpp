#include "apps/halflit/scene_source.hpp"

#include "apps/halflit/built_in_scenes.hpp"
#include "apps/halflit/file_names.hpp"
#include "apps/halflit/stopwatch.hpp"
#include "apps/io/errno_text.hpp"
#include "halflit/model.hpp"

#include <fmt/core.h>

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace halflit::cli {
namespace {

constexpr const char* kStandardInput = "standard input";

/// Waits until standard input has something to read or has ended. time_limit_s: from `waiting` on; 0: none.
Result<void> wait_for_input(const Stopwatch& waiting, double time_limit_s) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    for (;;) {
        const double left_ms = time_limit_s > 0.0 ? std::ceil(time_limit_s * 1000.0 - waiting.ms()) : -1.0;
        if (time_limit_s > 0.0 && left_ms <= 0.0)
            return fail(ErrorCode::limit, fmt::format("{}: took more than {} s (--timeout)", kStandardInput, time_limit_s));
        if (::poll(&input, 1, static_cast<int>(std::min(left_ms, 1e9))) != 0) return {};  // an error is read's to tell
    }
}

Result<LoadedScene> load_file(const RenderOptions& options) {
    LoadOptions load = options.load;
    load.threads = options.execution.threads;
    if (options.scene != "-") return load_model(options.scene, load);
    const auto bytes = read_standard_input(options.load.limits.max_file_bytes, options.load.limits.time_limit_s);
    if (!bytes) return tl::unexpected(bytes.error());
    return load_model_bytes(*bytes, kStandardInput, "", load);
}

}  // namespace

Result<std::vector<std::byte>> read_standard_input(std::size_t max_bytes, double time_limit_s) {
    if (::isatty(STDIN_FILENO) == 1) return fail(ErrorCode::usage, "standard input: expected a model, found a terminal");
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    const Stopwatch reading;
    std::vector<std::byte> bytes;
    for (;;) {
        if (const auto waited = wait_for_input(reading, time_limit_s); !waited) return tl::unexpected(waited.error());
        const std::size_t size = bytes.size();
        if (size > max_bytes)
            return fail(ErrorCode::limit, fmt::format("{}: more than {} bytes (--max-file-bytes)", kStandardInput, max_bytes));
        bytes.resize(size + kChunk);
        const ssize_t got = ::read(STDIN_FILENO, bytes.data() + size, kChunk);
        const int error = errno;
        bytes.resize(size + (got > 0 ? static_cast<std::size_t>(got) : 0));
        if (got == 0) return bytes;
        if (got < 0 && error != EINTR) return fail(ErrorCode::io, fmt::format("{}: {}", kStandardInput, io::errno_text(error)));
    }
}

Result<SceneSource> load_scene(const RenderOptions& options) {
    const std::string name = options.scene.empty() ? "demo" : options.scene;
    auto built_in = built_in_scene(name);
    if (!built_in) return tl::unexpected(built_in.error());
    if (*built_in)
        return SceneSource{.name = name, .scene = std::make_unique<Scene>(std::move(**built_in)), .file = std::nullopt, .warnings = {}};
    auto loaded = load_file(options);
    if (!loaded && loaded.error().code == ErrorCode::io && name != "-")
        return fail(ErrorCode::io, loaded.error().message + did_you_mean_file(name, {"demo", "sphere:N", "lights:N"}));
    if (!loaded) return tl::unexpected(loaded.error());
    return SceneSource{name == "-" ? kStandardInput : name,
                       std::make_unique<Scene>(std::move(loaded->scene)),
                       std::move(loaded->info),
                       std::move(loaded->warnings),
                       std::move(loaded->animations),
                       loaded->animation,
                       loaded->origin,
                       loaded->scale,
                       std::move(loaded->motion)};
}

bool is_scene(const std::string& name) { return name == "-" || is_built_in_name(name) || is_model_name(name) || is_file(name); }

Result<EnvironmentImage> find_environment(const std::string& name) {
    if (name == "sky") return built_in_sky();
    if (name == "studio") return studio_image();
    auto environment = read_environment(name);
    if (!environment && environment.error().code == ErrorCode::io)
        return fail(ErrorCode::io, environment.error().message + did_you_mean_file(name, {"sky", "studio"}));
    return environment;
}

}  // namespace halflit::cli
