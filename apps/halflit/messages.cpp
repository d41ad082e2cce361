#include "apps/halflit/messages.hpp"

#include <cstdio>

namespace halflit::cli {
namespace {

void print_line(std::string_view kind, std::string_view message) {
    const std::string line = "halflit: " + std::string(kind) + printable(message) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void print_error(std::string_view message) {
    if (!message.empty()) print_line("error: ", message);
}

void print_warning(std::string_view message) { print_line("warning: ", message); }

void print_note(std::string_view message) { print_line("", message); }

}  // namespace halflit::cli
