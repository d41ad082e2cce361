#include "apps/halflit/program/progress_line.hpp"

#include "apps/halflit/program/messages.hpp"
#include "apps/io/platform/streams.hpp"

#include <fmt/core.h>

#include <cstdio>

namespace halflit::cli {
namespace {

constexpr double kEveryMs = 200;
constexpr double kLeastShare = 0.02;  // below, the time left would be a guess

}  // namespace

ProgressLine::ProgressLine(bool always, double delay_ms)
    : shown_((always || platform::is_terminal(platform::Stream::error)) && verbosity() != Verbosity::quiet), delay_ms_(delay_ms) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
    if (!shown_ || width_ == 0) return;
    overwrite("");
    std::fputc('\r', stderr);
    width_ = 0;
}

bool ProgressLine::due(bool last) {
    const double now = watch_.ms();
    if (!shown_ || now < delay_ms_ || (now - last_ms_ < kEveryMs && !last)) return false;
    last_ms_ = now;
    return true;
}

void ProgressLine::show(std::size_t done, std::size_t all) {
    if (due(done == all)) write(fmt::format("{} of {}, ", done, all), static_cast<double>(done) / static_cast<double>(all));
}

void ProgressLine::show(double share) {
    if (due(false)) write("", share);
}

void ProgressLine::write(std::string line, double share) {
    line = fmt::format("halflit: {}{} %", line, static_cast<int>(share * 100));
    if (share > kLeastShare) line += fmt::format(", {:.0f} s left", watch_.ms() / 1000 * (1 - share) / share);
    overwrite(std::move(line));
}

void ProgressLine::overwrite(std::string line) {
    const std::size_t width = line.size();
    if (width < width_) line.append(width_ - width, ' ');  // overwrites the rest of the line before
    width_ = width;
    std::fwrite("\r", 1, 1, stderr);
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
}

}  // namespace halflit::cli
