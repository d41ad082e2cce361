#include "apps/halflit/program/messages.hpp"

#include "apps/io/platform/streams.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace halflit::cli {
namespace {

Verbosity chosen_verbosity = Verbosity::usual;
thread_local std::string* held_lines = nullptr;

constexpr std::string_view kRed = "\x1b[1;31m", kYellow = "\x1b[1;33m", kPlain = "\x1b[0m";

bool coloured() {
    const char* refused = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    const bool dumb = terminal != nullptr && std::string_view(terminal) == "dumb";
    return platform::is_terminal(platform::Stream::error) && !dumb && (refused == nullptr || *refused == '\0');
}

/// `kind` is printed before the message, in `color` unless that is empty.
void print_line(std::string_view kind, std::string_view color, std::string_view message) {
    std::string line = "halflit: ";
    if (!kind.empty()) {
        if (coloured())
            line.append(color).append(kind).append(kPlain);
        else
            line.append(kind);
        line += ": ";
    }
    line += printable(message) + "\n";
    if (held_lines != nullptr)
        *held_lines += line;
    else
        std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void set_verbosity(Verbosity verbosity) { chosen_verbosity = verbosity; }

Verbosity verbosity() { return chosen_verbosity; }

void print_error(std::string_view message) {
    if (!message.empty()) print_line("error", kRed, message);
}

void print_warning(std::string_view message) {
    if (chosen_verbosity != Verbosity::quiet) print_line("warning", kYellow, message);
}

void print_note(std::string_view message) {
    if (chosen_verbosity != Verbosity::quiet) print_line("", "", message);
}

void print_detail(std::string_view message) {
    if (chosen_verbosity == Verbosity::verbose) print_line("", "", message);
}

HeldMessages::HeldMessages() { held_lines = &lines_; }
HeldMessages::~HeldMessages() { held_lines = nullptr; }
std::string HeldMessages::take() { return std::move(lines_); }

}  // namespace halflit::cli
