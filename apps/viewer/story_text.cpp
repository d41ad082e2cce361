// A pixel's story as lines of text.
#include "apps/halflit/flags/plan_names.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/viewer/pixel_story.hpp"

#include <fmt/core.h>

namespace halflit::viewer {
namespace {

std::string numbers(const Rgb3& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v[0], v[1], v[2]); }
std::string numbers(Vec3d v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }

std::string quoted(const std::string& name) { return name.empty() ? "" : " \"" + cli::printable(name) + "\""; }

std::string surface_text(const PixelStory& story) {
    constexpr const char* kKinds[] = {"triangle", "line", "point"};
    std::string text = fmt::format("{} {} of mesh {}{}, instance {}\n", kKinds[static_cast<std::size_t>(story.topology)], story.triangle,
                                   story.mesh, quoted(story.mesh_name), story.instance);
    text += fmt::format("material{}, lobe w {} n {}{}\n", quoted(story.material), story.lobe.wrap, story.lobe.power,
                        story.lobe.normalize ? ", normalised" : "");
    return text;
}

std::string geometry_text(const PixelStory& story) {
    std::string text = "\nposition  " + numbers(story.position) + "\nnormal    " + numbers(story.normal);
    text += "\nalbedo    " + numbers(story.albedo);
    text += fmt::format("\ndepth     {:.5g}, covers {:.4g} % of the pixel\n", story.depth, 100.0 * story.coverage);
    for (const Vec3d& corner : story.corners) text += "corner    " + numbers(corner) + "\n";
    return text;
}

std::string share_text(const LightShare& share) {
    std::string text = fmt::format("{:2} {:<11} {}\n", share.index, kind_of(share.type).name, numbers(share.linear));
    text += fmt::format("   N.L {:.3f}, lobe {:.3f}, Lambert {:.3f}, ", share.cosine, share.lobe, share.lambert);
    return text + (share.unhidden ? fmt::format("seen {:.0f} %\n", 100.0 * *share.unhidden) : "no light\n");
}

}  // namespace

std::string story_text(const PixelStory& story) {
    std::string text = fmt::format("pixel {}, {}: #{:02x}{:02x}{:02x}, alpha {}\n", story.x, story.y, story.codes[0], story.codes[1],
                                   story.codes[2], story.codes[3]);
    text += story.hit ? surface_text(story) : "no surface at the first sample: background or a transparent layer\n";
    if (!story.no_reference.empty())
        text += "error against float64: not known: " + cli::printable(story.no_reference) + "\n";
    else
        text += fmt::format("error against float64: {:.2g} {:.2g} {:.2g}\n  codes, of {:.2f} {:.2f} {:.2f}\n", story.error_codes[0],
                            story.error_codes[1], story.error_codes[2], story.reference_codes[0], story.reference_codes[1],
                            story.reference_codes[2]);
    if (story.bound_codes > 0.0) text += fmt::format("  promised for the frame: at most {:.3g}\n", story.bound_codes);
    text += "\nlinear light, after exposure\n";
    for (const LightShare& share : story.shares) text += share_text(share);
    if (story.lights_left_out > 0) text += fmt::format("   and {} lights that may give less\n", story.lights_left_out);
    text += "   all around  " + numbers(story.around) + "\n   emitted     " + numbers(story.emitted) + "\n   pixel       " +
            numbers(story.sum) + "\n";
    return story.hit ? text + geometry_text(story) : text;
}

}  // namespace halflit::viewer
