#include "apps/engine/answers/pixel_stories.hpp"

#include "apps/engine/answers/pixel_story_json.hpp"
#include "apps/engine/answers/pixel_story_text.hpp"
#include "halflit/explain.hpp"

#include <fmt/core.h>

#include <utility>

namespace halflit::engine {

Result<PixelStories> tell_pixels(const RenderJob& job, std::span<const PixelPlace> pixels) {
    for (const auto& [x, y] : pixels)
        if (x >= job.width || y >= job.height)
            return fail(ErrorCode::usage,
                        fmt::format("--pixel: expected a pixel of the {}x{} picture, found {},{}", job.width, job.height, x, y));
    const NameOfInstance name = names_of(job.source.parts);
    Renderer renderer;
    PixelStories stories{report_head("explain"), {}};
    Json list = Json::array();
    for (const auto& [x, y] : pixels) {
        auto told = explain_pixel(renderer, *job.prepared, job.light, job.camera, job.settings, {job.width, job.height}, x, y,
                                  job.timed_execution());
        if (!told) return tl::unexpected(told.error());
        const PixelStory story = in_file(std::move(*told), job.source.placement);
        list.push_back(story_json(story, name));
        stories.text += (stories.text.empty() ? "" : "\n") + story_text(story, name);
    }
    stories.report["scene"] = job.source.name;
    stories.report["size"] = {job.width, job.height};
    stories.report["pixels"] = std::move(list);
    return stories;
}

Result<PixelStories> explain(RenderOptions options, std::span<const PixelPlace> pixels) {
    if (pixels.empty()) return fail(ErrorCode::usage, "explain: expected --pixel X,Y");
    options.may_want_reference = true;  // for the error
    const auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    auto stories = tell_pixels(*job, pixels);
    if (stories) stories->warnings = job->warnings, stories->choices = job->choices;
    return stories;
}

Flag pixel_flag(std::vector<PixelPlace>& pixels) {
    return {.names = "--pixel",
            .form = "X,Y",
            .help = "The pixel, counted from the upper left corner; may be given several times",
            .read = appended(pixels, parse_pixel),
            .repeated = true};
}

}  // namespace halflit::engine
