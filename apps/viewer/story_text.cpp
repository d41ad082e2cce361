// A pixel's story as lines of text.
#include "apps/halflit/messages.hpp"
#include "apps/halflit/plan_names.hpp"
#include "apps/viewer/pixel_story.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace halflit::viewer {
namespace {

std::string numbers(const Rgb3& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v[0], v[1], v[2]); }
std::string numbers(Vec3d v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }

std::string quoted(const std::string& name) { return name.empty() ? "" : " \"" + cli::printable(name) + "\""; }

std::string surface_text(const PixelStory& story) {
    constexpr const char* kKinds[] = {"triangle", "line", "point"};
    std::string text = fmt::format("{} {} of mesh {}{}, instance {}\n", kKinds[static_cast<std::size_t>(story.topology)], story.triangle,
                                   story.mesh, quoted(story.mesh_name), story.instance);
    for (const Vec3d& corner : story.corners) text += "  corner    " + numbers(corner) + "\n";
    text += "  position  " + numbers(story.position) + fmt::format("\n  depth     {:.5g}, covers {:.4g} % of the pixel\n", story.depth,
                                                                   100.0 * story.coverage);
    text += "  normal    " + numbers(story.normal) + "\n  albedo    " + numbers(story.albedo) + "\n";
    text += fmt::format("  material{}, lobe w {} n {}{}\n", quoted(story.material), story.lobe.wrap, story.lobe.power,
                        story.lobe.normalize ? ", normalised" : "");
    return text;
}

std::string share_text(const LightShare& share) {
    std::string text = fmt::format("light {} {}: {}\n", share.index, cli::kLightTypeNames[static_cast<std::size_t>(share.type)],
                                   numbers(share.linear));
    text += fmt::format("  N.L {:.3f}: lobe {:.3f}, Lambert {:.3f}", share.cosine, share.lobe, share.lambert);
    if (share.distance > 0.0) text += fmt::format("; distance {:.4g}", share.distance);
    text += share.unhidden ? fmt::format("; {:.0f} % unhidden\n", 100.0 * *share.unhidden) : "; gives no light here\n";
    return text;
}

}  // namespace

std::string story_text(const PixelStory& story) {
    std::string text = fmt::format("pixel {}, {}: #{:02x}{:02x}{:02x}, alpha {}\n", story.x, story.y, story.codes[0], story.codes[1],
                                   story.codes[2], story.codes[3]);
    text += story.hit ? surface_text(story) : "no surface at the first sample: background or a transparent layer\n";
    text += "\nlinear light, after exposure:\n";
    for (const LightShare& share : story.shares) text += share_text(share);
    if (story.lights_left_out > 0) text += fmt::format("{} more lights, each weaker\n", story.lights_left_out);
    text += "all around: " + numbers(story.around) + "\nemitted:    " + numbers(story.emitted) + "\npixel:      " + numbers(story.sum) + "\n";
    text += "\nerror against float64, in 8-bit codes:\n  " + fmt::format("{:.2g} {:.2g} {:.2g}", story.error_codes[0], story.error_codes[1],
                                                                         story.error_codes[2]);
    text += fmt::format(" of {:.2f} {:.2f} {:.2f}\n", story.reference_codes[0], story.reference_codes[1], story.reference_codes[2]);
    if (story.bound_codes > 0.0) text += fmt::format("  promised: at most {:.3g}\n", story.bound_codes);
    return text;
}

}  // namespace halflit::viewer
