// Messages to people: one line each, on standard error. Standard output is for data. "error" and "warning" are coloured if standard error
// is a terminal and the environment variable NO_COLOR is not set.
#pragma once

#include "apps/engine/basics/printable.hpp"
#include "apps/halflit/program/engine.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace halflit::cli {

enum class Verbosity : std::uint8_t {
    quiet,  ///< errors alone
    usual,  ///< also warnings, notes and progress
    verbose
};
/// Set before other threads start.
void set_verbosity(Verbosity verbosity);
[[nodiscard]] Verbosity verbosity();

/// "halflit: error: MESSAGE". Prints nothing for an empty message.
void print_error(std::string_view message);
/// "halflit: warning: MESSAGE"
void print_warning(std::string_view message);
/// "halflit: MESSAGE"
void print_note(std::string_view message);
/// The same, if verbose.
void print_detail(std::string_view message);

/// As long as it lives, messages of this thread are kept, not shown.
class HeldMessages {
public:
    HeldMessages();
    ~HeldMessages();
    HeldMessages(const HeldMessages&) = delete;
    HeldMessages& operator=(const HeldMessages&) = delete;

    /// The lines so far, as they would have been shown.
    [[nodiscard]] std::string take();

private:
    std::string lines_;
};

}  // namespace halflit::cli
