// Visible triangle at each pixel: halflit against Mesa's llvmpipe, ten scenes of random triangles at 1920 x 1080.
//
// Both get the same clip coordinates to the bit and follow the same rules (24.8 fixed point, exact edges, top-left rule). Two differences
// are known and allowed for. Mesa's window transform is fused where the processor can do it, so a corner may snap to the neighbouring 1/256
// pixel. Mesa clips at the view volume in float, while halflit clips far outside of it.
// Exit code: 0 agreed, 1 differs by more than the limits, 4 skipped (no llvmpipe here).
#include "mesa_ids.hpp"
#include "peer_scenes.hpp"
#include "rule_ids.hpp"
#include "tests/raster/debug_view.hpp"

#include <cstdio>

using namespace halflit;
using namespace halflit::peer;

namespace {

constexpr int kLimitInside = 10, kLimitAcross = 100;  // differing pixels, of 2,073,600
constexpr int kListed = 10;                           // differences printed in full
constexpr float kGuardBandPx = 16384;                 // halflit clips triangles that reach further from the middle of the picture

using Ids = std::vector<std::uint32_t>;

/// True if the triangle reaches further from the middle of the picture than the given half sizes; false for the background.
bool beyond(const PeerScene& scene, std::uint32_t id, float half_width_px, float half_height_px) {
    return id != 0 && reaches_beyond(std::span<const Vec4f, 3>(scene.clip_positions.data() + 3 * (id - 1), 3),
                                     half_width_px / (0.5f * kWidth), half_height_px / (0.5f * kHeight));
}

/// Reason why Mesa shows another triangle than halflit at pixel i; `fused` and `plain` are the rules with either window transform.
const char* explanation(const PeerScene& scene, std::size_t i, const Ids& ours, const Ids& mesa, const Ids& plain, const Ids& fused) {
    if (ours[i] != plain[i]) {
        const bool guard = beyond(scene, ours[i], kGuardBandPx, kGuardBandPx) || beyond(scene, plain[i], kGuardBandPx, kGuardBandPx);
        return guard ? "clipping at the guard band moved an edge" : "unexplained: halflit departs from the rules";
    }
    if (mesa[i] == fused[i]) return "a corner snaps differently after the fused window transform";
    const bool frame = beyond(scene, ours[i], 0.5f * kWidth, 0.5f * kHeight) || beyond(scene, mesa[i], 0.5f * kWidth, 0.5f * kHeight);
    return frame ? "Mesa's clipping at the view volume moved an edge" : "unexplained";
}

/// True when the scene agrees within its limit and every difference is explained.
bool compare(const PeerScene& scene, Mesa& mesa) {
    const auto ours = raster::triangle_ids(scene.scene, scene.camera, {}, kWidth, kHeight);
    if (!ours) {
        std::printf("%-32s halflit: %s\n", scene.name.c_str(), ours.error().message.c_str());
        return false;
    }
    const Ids theirs = mesa.ids(kWidth, kHeight, scene.clip_positions);
    if (theirs.size() != ours->size()) {
        std::printf("%-32s Mesa could not draw it\n", scene.name.c_str());
        return false;
    }
    const Ids plain = rule_ids(kWidth, kHeight, scene.clip_positions, Viewport::unfused);
    const Ids fused = rule_ids(kWidth, kHeight, scene.clip_positions, Viewport::fused);

    bool beyond_guard_band = false;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t)
        beyond_guard_band |= beyond(scene, static_cast<std::uint32_t>(t + 1), kGuardBandPx, kGuardBandPx);
    int covered = 0, differences = 0, from_rules = 0, unexplained = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        covered += plain[i] != 0;
        from_rules += (*ours)[i] != plain[i];
        differences += (*ours)[i] != theirs[i];
    }
    const int limit = scene.crosses_frame ? kLimitAcross : kLimitInside;
    std::printf("%-32s %6zu triangles, %7d pixels covered: %d differ from Mesa (limit %d), %d from the rules without clipping\n",
                scene.name.c_str(), scene.triangle_count(), covered, differences, limit, from_rules);
    int listed = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        if ((*ours)[i] == theirs[i]) continue;
        const char* why = explanation(scene, i, *ours, theirs, plain, fused);
        unexplained += why[0] == 'u';
        if (listed++ < kListed)
            std::printf("    pixel (%zu, %zu): halflit %u, Mesa %u: %s\n", i % kWidth, i / kWidth, (*ours)[i], theirs[i], why);
    }
    if (covered == 0) std::printf("    nothing is covered: nothing was compared\n");
    return covered > 0 && differences <= limit && unexplained == 0 && (beyond_guard_band || from_rules == 0);
}

}  // namespace

int main() {
    std::string reason;
    const std::unique_ptr<Mesa> mesa = Mesa::create(reason);
    if (!mesa) {
        std::printf("skipped: %s\n", reason.c_str());
        return 4;
    }
    std::printf("peer: %s\n", mesa->renderer().c_str());
    bool good = true;
    for (const PeerScene& scene : peer_scenes()) good &= compare(scene, *mesa);
    return good ? 0 : 1;
}
