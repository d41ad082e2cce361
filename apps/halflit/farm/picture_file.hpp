// One scene's picture: drawn, encoded, and written with the files beside it.
#pragma once

#include "apps/engine/job/aov.hpp"
#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/farm/shard.hpp"
#include "apps/halflit/program/engine.hpp"
#include "halflit/image.hpp"

#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {
struct RenderJob;
}
namespace halflit::cli {

/// One of several outputs of a run: the scene's place among the scenes.
struct ScenePlace {
    std::size_t index = 0, scenes = 1;
};

struct PictureOptions : RenderOptions {
    std::string output;                  ///< empty: named after the scene
    std::string report;                  ///< empty: none
    std::optional<OutputFormat> format;  ///< none: the name's
    std::vector<Aov> aovs;
    std::optional<Shard> shard;       ///< the part of the run; none: all of it
    std::optional<ScenePlace> place;  ///< of many scenes
    bool blank_check = false;         ///< tell pictures in which nothing is seen

    /// The picture, and the files beside it.
    [[nodiscard]] std::vector<std::string> pictures() const;
    [[nodiscard]] Result<OutputFormat> picture_format() const;
};

/// The scene's name without folder and extension, and the format's extension, ".png" without one.
[[nodiscard]] std::string default_output(const std::string& scene, std::optional<OutputFormat> format);

/// Refuses a report that would replace a file which is no report.
[[nodiscard]] Result<void> check_report(const std::string& path);

/// Calls make(), which returns a Result; where memory ends, the message names --max-memory if it was given.
template <class Make>
[[nodiscard]] auto within_memory(const RenderOptions& options, const Make& make) {
    constexpr const char* kOutOfMemory = "out of memory";  // in the libraries' messages too
    decltype(make()) done = fail(ErrorCode::limit, kOutOfMemory);
    try {
        done = make();
    } catch (const std::bad_alloc&) {
        // Keeps the error.
    }
    if (!done && options.max_memory_bytes > 0 && done.error().message.find(kOutOfMemory) != std::string::npos)
        done = fail(done.error().code, done.error().message + " (--max-memory " + std::to_string(options.max_memory_bytes >> 20) + ")");
    return done;
}

/// Refuses output paths that would overwrite the scene, the environment or each other.
[[nodiscard]] Result<void> check_paths(const PictureOptions& options);

/// One frame of a moving picture, and what a file of all its frames needs to know.
struct FilmFrame {
    std::int64_t number = 0;
    FrameRange whole;
    film::FrameTime time;
    bool opaque = true;  ///< no pixel of any frame is transparent
};

/// A picture that was drawn, and is not written yet.
struct PictureFile {
    std::string output;
    std::vector<std::uint8_t> bytes;
    AovFiles beside;
    std::string report;                ///< JSON, of one line where many pictures are drawn
    bool blank = false;                ///< nothing is seen; false without PictureOptions::blank_check
    std::optional<FilmFrame> frame{};  ///< of a moving picture
    std::optional<Region> part_of{};   ///< of a part of a picture: what all parts make together
    std::optional<Shard> shard{};
    std::optional<ScenePlace> place{};
    std::optional<MeasuredShare> measured{};  ///< of the film
    std::uint64_t file_hash = 0;              ///< of the bytes in the file; 0: they are in no file of their own
};

/// Refuses to overwrite a file that the scene refers to, such as a texture that has the picture's name. If the report would, it is not
/// written at all: its path is cleared.
[[nodiscard]] Result<void> spare_inputs(PictureOptions& options, const RenderJob& job);

/// Draws and encodes. Warnings are printed. `options.report` is cleared where it would overwrite a file that the scene refers to.
/// one_of_many: no progress line, and a report of one line.
[[nodiscard]] Result<PictureFile> draw_picture(PictureOptions& options, bool one_of_many = false);

/// Writes the files beside a picture, then the picture: where that is, they are whole.
[[nodiscard]] Result<void> write_with_aovs(const std::string& output, std::span<const std::uint8_t> bytes, const AovFiles& beside);

/// The same, and tells of it; one_of_many: in detail alone.
[[nodiscard]] Result<void> write_picture(const PictureFile& picture, bool one_of_many = false);

}  // namespace halflit::cli
