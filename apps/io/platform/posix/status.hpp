// A file's status as POSIX tells it.
#pragma once

#include "apps/io/platform/files.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace halflit::platform {

inline FileStatus to_status(const struct stat& info) {
    FileStatus status;
    status.kind = S_ISREG(info.st_mode)    ? FileKind::file
                  : S_ISDIR(info.st_mode)  ? FileKind::folder
                  : S_ISFIFO(info.st_mode) ? FileKind::pipe
                                           : FileKind::device;
    status.bytes = info.st_size > 0 ? static_cast<std::uint64_t>(info.st_size) : 0;
    status.id = {static_cast<std::uint64_t>(info.st_dev), static_cast<std::uint64_t>(info.st_ino)};
#ifdef __APPLE__
    const timespec& changed = info.st_mtimespec;
#else
    const timespec& changed = info.st_mtim;
#endif
    constexpr std::int64_t kMost = 9'000'000'000;  // seconds that int64 holds as nanoseconds, until the year 2255
    status.changed_ns = std::clamp<std::int64_t>(changed.tv_sec, -kMost, kMost) * 1'000'000'000 + changed.tv_nsec;
    status.mode = static_cast<unsigned>(info.st_mode) & 0777;
    return status;
}

}  // namespace halflit::platform
