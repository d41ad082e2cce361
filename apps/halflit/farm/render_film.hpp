// A scene as a moving picture: a file for each frame, or one for all.
#pragma once

#include "apps/halflit/farm/picture_file.hpp"

namespace halflit::cli {

/// Draws the frames that `options.film` asks for. The scene is read and prepared once; each frame redoes what moves. While a frame is
/// drawn, the one before is encoded on another thread. `options.output` has a place for the frame's number, or names a .gif, .apng or .webp
/// file; a folder or an empty one gets a name of the scene. skip_existing: leave frames alone whose
/// files are there. Returns the exit code.
[[nodiscard]] Result<int> render_film(PictureOptions options, bool skip_existing);

}  // namespace halflit::cli
