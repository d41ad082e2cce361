// Flags of moving pictures: which frames, how fast, and how the view turns.
#pragma once

#include "apps/engine/film/film_writer.hpp"
#include "halflit/error.hpp"
#include "halflit/math.hpp"
#include "halflit/report.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace halflit::engine {

/// Numbers first, first + step, ... up to last.
struct FrameRange {
    std::int64_t first = 0, last = 0, step = 1;
    [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>((last - first) / step + 1); }
    [[nodiscard]] std::int64_t number(std::size_t i) const { return first + static_cast<std::int64_t>(i) * step; }
};

/// "A-B", "A-B:STEP" or "A": numbers from 0 to 9,999,999, A at most B, STEP from 1.
[[nodiscard]] Result<FrameRange> parse_frames(std::string_view text);

/// Frames a second, as a fraction: "24", "23.976" (at most three decimals), "30000/1001". From 0.001 to 1000.
struct FrameRate {
    std::int64_t frames = 24, seconds = 1;
};
[[nodiscard]] Result<FrameRate> parse_fps(std::string_view text);

/// A side to look from.
struct GivenView {
    std::string name;  ///< of kNamedViews, or the two numbers: "30,-20"
    float azimuth_deg = 0, elevation_deg = 0;
    bool named = false;             ///< relative to the model's front
    bool of_file = false;           ///< a camera of --camera-file; `name` is that of its picture
    std::optional<Vec3d> facing{};  ///< in place of the angles: the normal of a --section that the view faces, in the file's world
};

/// Names of kNamedViews, and pairs of numbers AZIMUTH,ELEVATION, with commas between them.
[[nodiscard]] Result<std::vector<GivenView>> parse_views(std::string_view text);

/// Those of a sheet and of a comparison where the flags name none: front, right, top and iso.
[[nodiscard]] std::vector<GivenView> usual_views();

struct FilmOptions {
    std::vector<GivenView> views;  ///< each has a picture; a single one is not moving
    std::optional<FrameRange> frames;
    std::optional<FrameRate> fps;
    int turntable = 0;                   ///< frames of one turn; 0: the view stands still
    bool time_held = false;              ///< --time was given: the pose of that time in all frames
    bool dither = false;                 ///< GIF
    std::optional<ShareBudget> quality;  ///< --quality other than full
    std::optional<double> share;         ///< --share, percent: with --max-error, instead of quality

    /// Frames are asked for.
    [[nodiscard]] bool wanted() const { return frames || turntable > 0 || several_views(); }
    [[nodiscard]] bool several_views() const { return views.size() > 1 || (views.size() == 1 && views[0].of_file); }
    /// The frames differ: the view turns, or the scene moves.
    [[nodiscard]] bool moves() const { return wanted() && (turntable > 0 || animates()); }
    /// The animation runs. A turntable shows one pose unless it has a frame rate.
    [[nodiscard]] bool animates() const { return !time_held && frames && (turntable == 0 || fps); }
    /// --frames, one turn, or one for each view.
    [[nodiscard]] FrameRange range() const {
        return frames.value_or(FrameRange{0, (several_views() ? static_cast<std::int64_t>(views.size()) : turntable) - 1, 1});
    }
    /// --fps, or 24 for an animation and 12 for a turntable.
    [[nodiscard]] FrameRate rate() const { return fps.value_or(FrameRate{animates() ? 24 : 12, 1}); }
    /// Seconds of the animation at a frame's number.
    [[nodiscard]] double time_s(std::int64_t number) const {
        return static_cast<double>(number * rate().seconds) / static_cast<double>(rate().frames);
    }
    /// Time that each frame is shown: that of all the frames which the range steps over.
    [[nodiscard]] film::FrameTime frame_time() const { return {range().step * rate().seconds, rate().frames}; }
};

/// Error of a --share without what it needs.
inline constexpr const char* kShareNeeds = "--share: expected together with --max-error, and with --frames or --turntable";
/// "full", "fast" or "draft".
[[nodiscard]] Result<std::optional<ShareBudget>> parse_quality(std::string_view text);

/// Refuses flags that contradict each other. output: of -o.
[[nodiscard]] Result<void> check_film_options(const FilmOptions& options, const std::string& output);

/// The file of a frame. In a pattern, {} and {frame} are its number, {:04} and {frame:04} with zeros in front; {stem} is the scene's name
/// without folder and extension, {folder} its folder, {view} the name of its view, if there are several. Fails (usage) for other words in
/// braces, and for a pattern that gives all frames one name.
[[nodiscard]] Result<std::string> frame_name(const std::string& pattern, const std::string& scene, const FilmOptions& film,
                                             std::int64_t number);

}  // namespace halflit::engine
