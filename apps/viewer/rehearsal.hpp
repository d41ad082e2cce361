// A run without a person: motions of a mouse in the order of a person's, one for each picture, and the times between pictures.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace halflit::viewer {

struct RehearsalPlan {
    int orbit_frames = 0;  ///< pictures of a turn around the scene; 0: no turn
    struct Pixel {
        int x, y;
    };
    std::optional<Pixel> click{};  ///< then, once all samples are drawn
    bool wanted = false;           ///< false: a person sits before the window
};

/// The window's state, as the rehearsal sees it.
struct Situation {
    double now_ms = 0;
    bool new_picture = false;  ///< one was drawn since the last call
    bool finished = false;     ///< all samples of the view are shown
    bool story_shown = false;  ///< that of the last click
};

enum class Gesture { none, press, drag, release, click, end };

struct RehearsalStep {
    Gesture gesture = Gesture::none;
    int dx = 0;  ///< drag: motion to the right, pixels
};

class Rehearsal {
public:
    Rehearsal(const RehearsalPlan& plan, int pixels_of_turn) : plan_(plan), pixels_of_turn_(pixels_of_turn), expected_(plan.orbit_frames) {}

    /// To be called after each picture that was drawn, and while nothing happens.
    [[nodiscard]] RehearsalStep next(const Situation& now);
    /// A new picture is in the window.
    void shown(double now_ms);

    /// Times from one shown picture to the next one during the turn, milliseconds; of the first one, from the first motion.
    [[nodiscard]] const std::vector<double>& intervals() const { return intervals_; }
    /// A motion of the turn was asked for whose picture is not there yet.
    [[nodiscard]] bool turning() const { return stage_ == Stage::turning && dragged_ > 0; }

private:
    enum class Stage { beginning, turning, resting, telling, ending };
    RehearsalPlan plan_;
    int pixels_of_turn_;
    int expected_;  ///< pictures of the turn
    Stage stage_ = Stage::beginning;
    int dragged_ = 0;  ///< motions so far
    double last_ms_ = 0;
    std::vector<double> intervals_;
};

}  // namespace halflit::viewer
