// Files that are either old or new, never half written. The bytes are written to a temporary file beside the target and flushed to the
// disk; then the temporary file is renamed to the target. If a step fails, the old file stays and the temporary one is removed.
#pragma once

#include "halflit/error.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace halflit::io {

/// Writes `bytes` to `path`; "-" is standard output. The temporary file is `.NAME.halflit-PID.tmp` in the same directory. A symbolic link
/// is followed; a device or pipe is written in place. Fails with ErrorCode::io and the system's reason. For a pipe or socket that its
/// reader has closed, the message is empty, because nobody reads the output.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);

/// Removes the temporary files of all threads; from then on only the calling thread may write files. Called before a signal ends the
/// process, but not inside a signal handler, because it locks.
void abandon_files();

}  // namespace halflit::io
