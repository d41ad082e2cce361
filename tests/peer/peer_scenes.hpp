// Random triangle scenes that two rasterizers can draw with the same clip coordinates to the bit: halflit gets a mesh and a camera,
// the peer gets the clip coordinates that halflit's vertex stage makes of them.
#pragma once

#include "halflit/scene.hpp"

#include <string>
#include <vector>

namespace halflit::peer {

inline constexpr int kWidth = 1920, kHeight = 1080;

/// Later triangles are nearer, and no two share a depth, so that painter's order and a depth test leave the same triangle on top.
struct PeerScene {
    std::string name;
    bool crosses_frame = false;  ///< some triangles reach over the border of the picture
    Scene scene;                 ///< one mesh, one instance without transform, one double-sided material
    Camera camera;
    std::vector<Vec4f> clip_positions;  ///< three a triangle, in submission order

    [[nodiscard]] std::size_t triangle_count() const { return clip_positions.size() / 3; }
};

/// Ten scenes from fixed seeds: six inside the frame, four across its border.
[[nodiscard]] std::vector<PeerScene> peer_scenes();

}  // namespace halflit::peer
