// Decides what to draw next: quick pictures while something moves, then all samples. It knows times and nothing of windows.
#pragma once

#include <optional>

namespace halflit::viewer {

/// A picture of a 1 / divisor of the width and the height.
struct DrawStep {
    int divisor = 1;
    int samples = 1;
    bool final_one = false;  ///< the view is finished with it
    friend bool operator==(const DrawStep&, const DrawStep&) = default;
};

/// While the view moves, pictures have one sample a pixel. One that takes longer than the target halves the sides of the next ones, unless
/// that was tried and gained less than a seventh: then the time is the geometry's. Sides are doubled again where four times the last time
/// is below the target. The first picture of all does not count, as it finds memory for the later ones. At rest follow one sample at full
/// size, if the last picture was smaller, and all samples.
class Refinement {
public:
    static constexpr double kTargetMs = 60.0;
    static constexpr double kRestMs = 120.0;  ///< without motion, until a view is at rest
    static constexpr int kMostDivisor = 4;

    /// all_samples: of a finished picture.
    explicit Refinement(int all_samples) : all_samples_(all_samples) {}

    /// The view or a control changed at this time.
    void moved(double now_ms);
    void set_samples(int all_samples, double now_ms);

    /// The next picture; none: the view is finished, or waits for more motion or rest.
    [[nodiscard]] std::optional<DrawStep> next(double now_ms) const;
    /// How long the loop may sleep before next() may answer otherwise, milliseconds; none: for ever.
    [[nodiscard]] std::optional<double> wait_ms(double now_ms) const;
    /// The step's picture of the present view was begun: motion from now on is another view.
    void began(const DrawStep& step);
    /// It is done, and what depends on its size took this long. dropped: it was given up, as the view moved on.
    void drawn(const DrawStep& step, double took_ms, bool dropped);

    [[nodiscard]] int divisor() const { return divisor_; }
    [[nodiscard]] bool finished() const { return stage_ == Stage::finished; }

private:
    enum class Stage { quick, shown, full_size, finished };
    void adapt(const DrawStep& step, double took_ms);

    int all_samples_;
    Stage stage_ = Stage::quick;  ///< what the present view has: nothing, a quick picture, one of full size, all
    int shown_divisor_ = 1;
    bool first_ = true;     ///< no picture is drawn yet
    bool changed_ = false;  ///< since the picture in the making was begun
    double moved_ms_ = -1e9;
    int divisor_ = 1;
    double larger_ms_ = 0;  ///< time of the last picture before the sides were halved; 0: none
    bool geometry_bound_ = false;
};

}  // namespace halflit::viewer
