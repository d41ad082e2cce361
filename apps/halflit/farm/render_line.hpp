// The command line of render: its flags, and the kind of run that they ask for. plan reads it too, to divide the run.
#pragma once

#include "apps/halflit/farm/picture_file.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::cli {

struct RenderLine : PictureOptions {
    std::vector<std::string> words;  ///< scenes, and the picture as the last of several
    std::string folder;              ///< of --out-dir
    std::string list;                ///< of --files-from
    bool skip_existing = false;
};

/// The arguments and flags of render, without the function that runs it. `line` must outlive what this returns.
[[nodiscard]] Command render_table(RenderLine& line);

enum class RenderKind : std::uint8_t {
    picture,  ///< one scene, one picture
    film,     ///< one scene, many frames
    many      ///< many scenes, each with a picture
};

/// Decides what the flags ask for together: puts the scenes into `words` and the output into `output`, which ends in '/' or is a pattern
/// for many scenes. Reads the file of --files-from. A shard's name comes into the
/// output of one picture and into the report; what only whole runs can make is refused.
[[nodiscard]] Result<RenderKind> settle(RenderLine& line);

}  // namespace halflit::cli
