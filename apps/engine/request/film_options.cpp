#include "apps/engine/request/film_options.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/io/files/file_access.hpp"
#include "halflit/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace halflit::engine {

Result<FrameRange> parse_frames(std::string_view text) {
    constexpr std::int64_t kMostFrame = 9'999'999;
    const auto wrong = [&] {
        return fail(ErrorCode::usage, fmt::format("expected A-B or A-B:STEP, with A up to B and B up to {}, as 0-47 or 0-47:2, found '{}'",
                                                  kMostFrame, text));
    };
    const std::size_t colon = text.find(':');
    const std::string_view range = text.substr(0, colon);
    const std::size_t dash = range.find('-');
    const auto first = parse_int(range.substr(0, dash), 0, kMostFrame);
    if (!first) return wrong();
    FrameRange out{*first, *first, 1};
    if (dash != std::string_view::npos) {
        const auto last = parse_int(range.substr(dash + 1), *first, kMostFrame);
        if (!last) return wrong();
        out.last = *last;
    }
    if (colon != std::string_view::npos) {
        const auto step = parse_int(text.substr(colon + 1), 1, kMostFrame);
        if (!step || dash == std::string_view::npos) return wrong();
        out.step = *step;
    }
    return out;
}

Result<FrameRate> parse_fps(std::string_view text) {
    constexpr std::int64_t kMost = 1'000'000;
    const auto wrong = [&] {
        return fail(ErrorCode::usage,
                    fmt::format("expected frames a second from 0.001 to 1000, as 24, 23.976 or 30000/1001, found '{}'", text));
    };
    FrameRate rate{0, 1};
    const std::size_t slash = text.find('/'), dot = text.find('.');
    if (slash != std::string_view::npos) {
        const auto frames = parse_int(text.substr(0, slash), 1, kMost), seconds = parse_int(text.substr(slash + 1), 1, kMost);
        if (!frames || !seconds) return wrong();
        rate = {*frames, *seconds};
    } else {
        const std::string_view whole = text.substr(0, dot);
        const auto units = parse_int(whole, 0, 1000);
        if (!units) return wrong();
        rate.frames = *units;
        if (dot != std::string_view::npos) {
            const std::string_view digits = text.substr(dot + 1);
            if (digits.empty() || digits.size() > 3 || digits.find_first_not_of("0123456789") != std::string_view::npos) return wrong();
            for (const char digit : digits) rate = {rate.frames * 10 + (digit - '0'), rate.seconds * 10};
        }
    }
    if (rate.frames > 1000 * rate.seconds || rate.frames * 1000 < rate.seconds) return wrong();
    const std::int64_t common = std::gcd(rate.frames, rate.seconds);
    return FrameRate{rate.frames / common, rate.seconds / common};
}

Result<std::optional<ShareBudget>> parse_quality(std::string_view text) {
    if (text == "full") return std::optional<ShareBudget>{};
    if (text == "fast") return std::optional(kFastQuality);
    if (text == "draft") return std::optional(kDraftQuality);
    return fail(ErrorCode::usage, fmt::format("expected draft, fast or full, found '{}'", text));
}

Result<void> check_film_options(const FilmOptions& options, const std::string& output) {
    if (!options.wanted()) {
        if (options.fps) return fail(ErrorCode::usage, "--fps: expected together with --frames or --turntable");
        if (options.share) return fail(ErrorCode::usage, kShareNeeds);
        return {};
    }
    if (!options.views.empty() && (options.frames || options.turntable > 0))
        return fail(ErrorCode::usage, "--view and --camera all: cannot be combined with --frames or --turntable");
    for (auto view = options.views.begin(); view != options.views.end(); ++view)
        if (std::any_of(options.views.begin(), view, [&](const GivenView& other) { return other.name == view->name; }))
            return fail(ErrorCode::usage, fmt::format("--view: expected each side once, found {} twice", view->name));
    if (options.time_held && options.turntable == 0 && options.frames)
        return fail(ErrorCode::usage, "--time: cannot be combined with --frames, whose frame N is at N / --fps seconds");
    if (output == "-")
        return fail(ErrorCode::usage, "-o -: cannot be combined with --frames, --turntable or several views, which need a file name");
    if (const auto format = film::film_format_of(output)) return film::check_film_format(output, *format);
    if (options.dither) return fail(ErrorCode::usage, "--dither: expected a .gif file as the output");
    return {};
}

Result<std::vector<GivenView>> parse_views(std::string_view text) {
    std::vector<std::string> names;
    for (const NamedView& view : kNamedViews) names.emplace_back(view.name);
    const std::vector<std::string> words = words_of(text, ',');
    std::vector<GivenView> views;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto named = std::find(names.begin(), names.end(), words[i]);
        if (named != names.end()) {
            const NamedView& view = kNamedViews[named - names.begin()];
            views.push_back({*named, view.azimuth_deg, view.elevation_deg, true});
            continue;
        }
        const auto azimuth = parse_float(words[i], -3600, 3600);
        if (!azimuth)
            return fail(ErrorCode::usage, fmt::format("expected {} or AZIMUTH,ELEVATION, found '{}'{}", joined(names, ", "), words[i],
                                                      did_you_mean(words[i], names)));
        const auto elevation = i + 1 < words.size() ? parse_float(words[i + 1], -90, 90) : fail(ErrorCode::usage, "");
        if (!elevation)
            return fail(ErrorCode::usage, fmt::format("expected an elevation from -90 to 90 after the azimuth {}, found {}", words[i],
                                                      i + 1 < words.size() ? "'" + words[i + 1] + "'" : "nothing"));
        views.push_back({words[i] + "," + words[i + 1], *azimuth, *elevation, false});
        ++i;
    }
    return views;
}

std::vector<GivenView> usual_views() { return *parse_views("front,right,top,iso"); }

Result<std::string> frame_name(const std::string& pattern, const std::string& scene, const FilmOptions& film, std::int64_t number) {
    bool numbered = false;
    auto name = fill_pattern(pattern, "{}, {:04}, {view}, {stem} or {folder}", [&](std::string_view word) -> std::optional<std::string> {
        if (word == "view" && film.several_views()) {
            numbered = true;
            return film.views[static_cast<std::size_t>(number)].name;
        }
        if (word == "stem") return scene.empty() || scene == "-" ? "halflit" : stem_of(scene);
        if (word == "folder") return io::folder_of(scene);
        auto digits = digits_for(word, word.starts_with("frame") ? "frame" : "", number);
        numbered |= digits.has_value();
        return digits;
    });
    if (name && !numbered)
        return fail(ErrorCode::usage,
                    fmt::format("-o {}: expected a place for the {}, or a .gif, .apng or .webp file", pattern,
                                film.several_views() ? "view's name, as {view}.png" : "frame's number, as frame_{:04}.png"));
    return name;
}

}  // namespace halflit::engine
