// Pictures of what is seen beside the picture of light: depth, normals, base colours, positions, numbers (--aov).
#pragma once

#include "apps/halflit/render/render_job.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::cli {

enum class Aov : std::uint8_t { depth, normal, albedo, position, id, coverage, lights };

/// Indexed by Aov.
inline constexpr std::string_view kAovNames[] = {"depth", "normal", "albedo", "position", "id", "coverage", "lights"};

/// "depth,normal" as a list without repeats.
[[nodiscard]] Result<std::vector<Aov>> parse_aovs(const std::string& text);

/// The file beside a picture: "out.depth.exr" for "out.png"; .pfm where EXR files cannot be written, .png for whole numbers.
[[nodiscard]] std::string aov_path(const std::string& picture, Aov aov);

struct AovFile {
    Aov aov;
    std::string path;
    std::vector<std::uint8_t> bytes;
};

/// Memory of the planes that a list of AOVs needs.
class AovPlanes {
public:
    AovPlanes(const std::vector<Aov>& aovs, const RenderJob& job);

    /// Lets the planes be drawn too. The target must hold the region alone.
    void add_to(Target& target);

    /// The files, of a picture that was drawn. Distances and positions are those of the file's own world, turned upright by `up`. Fails
    /// (limit) for numbers that a 16-bit PNG does not hold.
    [[nodiscard]] Result<std::vector<AovFile>> encode(const std::string& picture, const RenderJob& job);

private:
    [[nodiscard]] bool has(Aov aov) const;
    void to_world_of_file(const RenderJob& job);
    [[nodiscard]] Result<std::vector<std::uint8_t>> encode(Aov aov) const;
    [[nodiscard]] Result<std::vector<std::uint8_t>> encode_numbers(Aov aov) const;

    std::vector<Aov> aovs_;
    int width_, height_;
    std::vector<float> depth_, normal_, albedo_, position_, coverage_;
    std::vector<std::uint32_t> id_, lights_;
};

}  // namespace halflit::cli
