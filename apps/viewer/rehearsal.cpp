#include "apps/viewer/rehearsal.hpp"

namespace halflit::viewer {

RehearsalStep Rehearsal::next(const Situation& now) {
    if (!plan_.wanted) return {};
    switch (stage_) {
        case Stage::beginning:
            if (!now.finished) return {};
            stage_ = plan_.orbit_frames > 0 ? Stage::turning : Stage::resting;
            return {stage_ == Stage::turning ? Gesture::press : Gesture::none};
        case Stage::turning: {
            if (dragged_ > 0 && !now.new_picture) {
                if (!now.finished) return {};
                // A first motion of a few pixels counts as none, as it may be a click's: no picture comes.
                --expected_;
                last_ms_ = now.now_ms;
            }
            if (dragged_ == 0) last_ms_ = now.now_ms;
            if (dragged_ == plan_.orbit_frames) {
                stage_ = Stage::resting;
                return {Gesture::release};
            }
            const auto place = [&](int i) { return static_cast<int>(static_cast<long long>(pixels_of_turn_) * i / plan_.orbit_frames); };
            ++dragged_;
            return {Gesture::drag, place(dragged_) - place(dragged_ - 1)};
        }
        case Stage::resting:
            if (!now.finished) return {};
            stage_ = plan_.click ? Stage::telling : Stage::ending;
            return {plan_.click ? Gesture::click : Gesture::none};
        case Stage::telling:
            if (now.story_shown) stage_ = Stage::ending;
            return {};
        case Stage::ending:
            return {Gesture::end};
    }
    return {};
}

void Rehearsal::shown(double now_ms) {
    if (dragged_ == 0 || intervals_.size() >= static_cast<std::size_t>(expected_)) return;
    intervals_.push_back(now_ms - last_ms_);
    last_ms_ = now_ms;
}

}  // namespace halflit::viewer
