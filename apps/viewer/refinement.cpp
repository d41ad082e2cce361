#include "apps/viewer/refinement.hpp"

#include <algorithm>

namespace halflit::viewer {

void Refinement::moved(double now_ms) {
    moved_ms_ = now_ms;
    changed_ = true;
    stage_ = Stage::quick;
}

void Refinement::set_samples(int all_samples, double now_ms) {
    if (all_samples == all_samples_) return;
    all_samples_ = all_samples;
    moved(now_ms);
}

std::optional<DrawStep> Refinement::next(double now_ms) const {
    const DrawStep quick{divisor_, 1, all_samples_ == 1 && divisor_ == 1};
    if (stage_ == Stage::quick) return quick;
    if (stage_ == Stage::finished || now_ms - moved_ms_ < kRestMs) return std::nullopt;
    if (stage_ == Stage::shown && shown_divisor_ > 1) return DrawStep{1, 1, all_samples_ == 1};
    return DrawStep{1, all_samples_, true};
}

std::optional<double> Refinement::wait_ms(double now_ms) const {
    if (stage_ == Stage::finished) return std::nullopt;
    return stage_ == Stage::quick ? 0.0 : std::max(0.0, kRestMs - (now_ms - moved_ms_));
}

void Refinement::began(const DrawStep&) { changed_ = false; }

void Refinement::drawn(const DrawStep& step, double took_ms, bool dropped) {
    if (dropped) return;
    if (step.samples == 1 && !first_) adapt(step, took_ms);
    first_ = false;
    if (changed_) return;  // the picture is that of an earlier view
    shown_divisor_ = step.divisor;
    stage_ = step.final_one ? Stage::finished : step.divisor == 1 ? Stage::full_size : Stage::shown;
}

void Refinement::adapt(const DrawStep& step, double took_ms) {
    constexpr double kWorthwhile = 6.0 / 7.0;
    if (took_ms <= kTargetMs) geometry_bound_ = false;
    if (step.divisor == divisor_ && larger_ms_ > 0.0) {  // the first picture of this size
        geometry_bound_ = took_ms > kTargetMs && took_ms > kWorthwhile * larger_ms_;
        larger_ms_ = 0.0;
        if (geometry_bound_) {
            divisor_ = std::max(1, divisor_ / 2);
            return;
        }
    }
    if (took_ms > kTargetMs && step.divisor >= divisor_ && divisor_ < kMostDivisor && !geometry_bound_) {
        divisor_ = step.divisor * 2;
        larger_ms_ = took_ms;
    } else if (step.divisor == divisor_ && divisor_ > 1 && 4.0 * took_ms < kTargetMs) {
        divisor_ /= 2;
    } else if (step.divisor < divisor_ && took_ms < 0.8 * kTargetMs) {
        divisor_ = step.divisor;  // a picture of full size at rest, after what slowed it is gone
    }
}

}  // namespace halflit::viewer
