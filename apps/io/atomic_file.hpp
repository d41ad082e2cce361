// Files that are either old or new, never half. The bytes go to a temporary file beside the target, are flushed to the disk, and take the
// target's name in one step. Whatever fails on the way, the old file stays and the temporary one is removed.
#pragma once

#include "shading/result.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace halflit::io {

/// Writes `bytes` to `path`; "-" is standard output. The temporary file is `.NAME.halflit-PID.tmp` in the same directory. A symbolic link
/// is followed; a device or pipe is written in place. Fails with ErrorCode::io and the system's reason. A pipe or socket that its reader
/// has closed is ErrorCode::io with an empty message: there is nobody to tell.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);

/// For a process that is about to end on a signal: removes the temporary files of all threads, and from then on only the calling thread
/// may write files. Not for use inside a signal handler (it locks).
void abandon_files();

}  // namespace halflit::io
