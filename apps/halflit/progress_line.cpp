#include "apps/halflit/progress_line.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>

namespace halflit::cli {
namespace {

constexpr double kEveryMs = 200;

}  // namespace

ProgressLine::ProgressLine(bool always) : shown_(always || ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
    if (!shown_ || width_ == 0) return;
    write("");
    std::fputc('\r', stderr);
}

void ProgressLine::show(std::size_t done, std::size_t all) {
    const double now = watch_.ms();
    if (!shown_ || (now - last_ms_ < kEveryMs && done != all)) return;
    last_ms_ = now;
    std::string line = fmt::format("halflit: {} of {}, {} %", done, all, done * 100 / all);
    if (done > 0) line += fmt::format(", {:.0f} s left", now / 1000 * static_cast<double>(all - done) / static_cast<double>(done));
    write(std::move(line));
}

void ProgressLine::write(std::string line) {
    const std::size_t width = line.size();
    if (width < width_) line.append(width_ - width, ' ');  // overwrites the rest of the line before
    width_ = width;
    std::fwrite("\r", 1, 1, stderr);
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
}

}  // namespace halflit::cli
