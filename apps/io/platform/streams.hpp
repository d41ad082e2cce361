// Standard streams and the terminal.
#pragma once

#include <cstddef>
#include <cstdint>

namespace halflit::platform {

enum class Stream : std::uint8_t { input, output, error };

/// Makes the standard streams safe to use, first of all in main(). A closed stream is occupied, because the next file opened would get its
/// number, and messages would be written into it. On Windows bytes stay as they are, and a terminal shows UTF-8 and colours.
void prepare_streams();
[[nodiscard]] bool is_terminal(Stream stream);
/// Columns of the terminal on standard output; 0: it is not a terminal.
[[nodiscard]] long terminal_columns();
/// Waits until standard input has something to read or has ended; below 0: for any time. False: nothing came in this time.
[[nodiscard]] bool wait_for_input(double ms);

}  // namespace halflit::platform
