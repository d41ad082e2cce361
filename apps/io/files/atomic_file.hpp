// Files that are either old or new, never half written. The bytes are written to a file without a name in the target's folder, and flushed
// to the disk if there is an old file; then the file gets the target's name. Where the system has no such files, a temporary one is
// renamed. If a step fails, the old file stays. After a power failure a new file may be empty or incomplete; one that replaces another is
// complete.
#pragma once

#include "halflit/error.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace halflit::io {

/// Writes `bytes` to `path`; "-" is standard output. A temporary file is `.NAME.halflit-PID.tmp` in the same directory; one that a killed
/// process has left there is removed by the next write of that target, if that makes temporary files too. A symbolic link
/// is followed; a device or pipe is written in place. Fails with ErrorCode::io and the system's reason. For a pipe or socket that its
/// reader has closed, the message is empty, because nobody reads the output.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);

/// Begins a set of files that belong together, such as a picture and its report. Once one of them has its name, abandon_files() waits for
/// the next set or the process's end, so that a process that ends by a signal has not finished its work.
void begin_file_set();

/// Removes the temporary files of all threads; from then on only the calling thread may write files, and others that try wait for the
/// process's end. Called before a signal ends the process, but not inside a signal handler, because it locks.
void abandon_files();

}  // namespace halflit::io
