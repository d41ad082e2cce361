// The heap of a program that draws: memory that is freed is used again, and lies in huge pages.
#pragma once

namespace halflit::cli {

/// To be called once, before a scene is loaded; later calls do nothing. A page fault for each 4 kB that is touched takes a fifth of the
/// time to draw a model, and memory of more than 128 kB is usually returned to the system and taken anew. With glibc on Linux, this
/// reserves a heap in whose pages of 2 MB the system may place memory, and lets the heap keep what is freed. It takes about 3 MB more.
/// Nothing is done where the process has a limit of memory, as what is reserved would count.
void prepare_heap();

}  // namespace halflit::cli
