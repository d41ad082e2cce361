// The report of one picture, of one of many, or of one frame of a film.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/farm/picture_file.hpp"
#include "apps/halflit/program/engine.hpp"

#include <string>

namespace halflit::cli {

/// The report of a picture that was drawn and encoded. one_line: as a line among others.
[[nodiscard]] std::string picture_report(const PictureFile& file, const RenderJob& job, const RenderReport& rendered, const Image& picture,
                                         double encode_ms, bool one_line);
/// The line of a picture that was there: {"status": "skipped", ...}. file: its output and place.
[[nodiscard]] std::string skipped_report(const std::string& scene, const PictureFile& file);

}  // namespace halflit::cli
