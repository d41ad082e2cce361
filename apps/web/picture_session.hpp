// The page's scene between two pictures: it stays loaded, prepared and lit as far as the flags allow.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/renderer.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::web {

/// Size of pictures without --size, as `halflit render` has it.
inline constexpr PictureSize kUsualSize = engine::kRenderSize;

class PictureSession {
public:
    /// Draws what `halflit render SCENE FLAGS` draws. Each flag is its long name, each value a word of its own.
    Result<void> draw(const std::string& scene, const std::vector<std::string>& flags);
    /// Draws it, and once more by --accuracy reference, and compares the two. picture() is then the error: the larger the difference in
    /// codes, the nearer to white; black where nothing is drawn.
    Result<void> compare(const std::string& scene, const std::vector<std::string>& flags);
    /// The next picture loads its scene anew, e.g. because files have changed.
    void forget_scene();

    [[nodiscard]] const Image& picture() const { return picture_; }
    /// JSON for the page about the last picture or comparison.
    [[nodiscard]] std::string report() const;

    /// Loads, prepares and lights what draw() would draw.
    Result<void> apply(const std::string& scene, const std::vector<std::string>& flags);
    /// Null before the first apply() or draw(), and where that failed.
    [[nodiscard]] const engine::RenderJob* job() const { return job_ ? &*job_ : nullptr; }
    /// The renderer's, of the last picture.
    [[nodiscard]] const RenderReport& rendered() const { return last_; }

private:
    Result<Image> render(const Settings& settings, bool linear);

    std::optional<engine::RenderJob> job_;
    std::string scene_flags_, light_flags_;  ///< those that the job was made and lit by
    Renderer renderer_;
    RenderReport last_;
    Image picture_;
    int loads_ = 0;           ///< scenes that were loaded
    std::string comparison_;  ///< its report; empty: the last picture is none
};

}  // namespace halflit::web
