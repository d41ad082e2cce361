// The heap of a program that draws: memory that is freed is used again, and lies in huge pages.
#pragma once

namespace halflit::cli {

/// Keeps freed memory, and asks for pages of 2 MB. To be called once, before a scene is loaded; later calls do nothing. Otherwise memory of
/// more than 128 kB is returned to the system and taken anew, and page faults, one for each 4 kB, take a fifth of the time to draw a model.
/// With glibc on Linux alone. Takes about 3 MB more. Nothing is done where the process has a limit of memory, as 128 MB of addresses are
/// reserved, which would count; so not for a process that sets one later.
void prepare_heap();

}  // namespace halflit::cli
