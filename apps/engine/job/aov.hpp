// Files of what is seen beside the picture of light: depth, normals, base colours, points of triangles, numbers (--aov).
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "halflit/fragment_planes.hpp"
#include "halflit/target.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// Value that a file holds for each pixel.
enum class AovFormat : std::uint8_t {
    floats,    ///< one or three floats: .exr, or .pfm where EXR files cannot be written
    share16,   ///< a share from 0 to 1, of 65535: PNG
    number16,  ///< a whole number up to 65535: PNG
    number32,  ///< a whole number: PNG of red, green, blue and alpha, its bytes from the least on
    depth16,   ///< 0: nothing; else 1 to 65535 from the least to the largest depth of the picture: PNG
};

/// A plane in memory: one of the two is used.
struct AovPlane {
    std::vector<float> floats;
    std::vector<std::uint32_t> numbers;
};

/// One file that --aov can write. The table of them is the only place that names them.
struct AovKind {
    std::string_view name;
    AovFormat format;
    int channels;                               ///< of the plane that is drawn
    float* Target::*floats = nullptr;           ///< the plane that is drawn for it,
    std::uint32_t* Target::*numbers = nullptr;  ///< or this one
    /// Makes what is written of what a camera saw; null: it is that.
    Result<void> (*derive)(const RenderJob&, const Camera&, AovPlane&) = nullptr;
    bool named = false;        ///< the numbers have names, which are written beside them
    std::string_view meaning;  ///< for documents
};

/// One of the table in aov.cpp.
using Aov = const AovKind*;

/// "depth,normal" as a list without repeats.
[[nodiscard]] Result<std::vector<Aov>> parse_aovs(const std::string& text);

/// Text of --help.
[[nodiscard]] std::string aov_help();

/// The files beside a picture, such as "out.depth.exr" for "out.png", and those that explain them.
[[nodiscard]] std::vector<std::string> aov_paths(const std::string& picture, std::span<const Aov> aovs);

struct AovFile {
    std::string name;  ///< of the AOV, or of the file that explains some
    std::string path;
    std::vector<std::uint8_t> bytes;
};

struct AovFiles {
    std::vector<AovFile> files;
    std::optional<DepthRange> depth16;
};

/// Memory of the planes that a list of AOVs needs, for one picture after the other.
class AovPlanes {
public:
    AovPlanes(const std::vector<Aov>& aovs, const RenderJob& job);

    /// Lets the planes be drawn too. The target must hold the region alone.
    void add_to(Target& target);

    /// Makes what is written of what was drawn by a camera. Distances and positions become those of the file's own world, turned upright by
    /// `up`.
    [[nodiscard]] Result<void> derive(const RenderJob& job, const Camera& camera);

    /// The files of what was derived; the scene may have changed since. Fails (limit) for numbers that a 16-bit PNG does not hold.
    [[nodiscard]] Result<AovFiles> encode(const std::string& picture) const;

private:
    struct Drawn {
        float* Target::*floats;
        std::uint32_t* Target::*numbers;
        AovPlane plane;
    };
    [[nodiscard]] AovPlane& drawn(float* Target::*floats, std::uint32_t* Target::*numbers, int channels);
    void to_world_of_file(const RenderJob& job);
    [[nodiscard]] Result<std::vector<std::uint8_t>> encode(const AovKind& aov, const AovPlane& plane, AovFiles& files) const;
    [[nodiscard]] Result<std::vector<std::uint8_t>> encode16(const AovKind& aov, const AovPlane& plane) const;
    [[nodiscard]] Result<std::vector<std::uint8_t>> encode_depth16(const std::vector<float>& depth, AovFiles& files) const;

    std::vector<Aov> aovs_;
    int width_, height_;
    std::vector<Drawn> drawn_;
    std::vector<AovPlane> derived_;  ///< of each AOV
    std::string names_;              ///< names_text() if an AOV is named
};

}  // namespace halflit::engine
