// Measurements of one scene: frames of llvmpipe and of halflit in turn, and the first frame of a process.
#pragma once

#include "bench/peer/child.hpp"
#include "bench/peer/compare.hpp"
#include "bench/peer/gl_scene.hpp"

#include <string>
#include <vector>

namespace halflit::peer {

struct Limits {
    int width = 1920, height = 1080;
    int rounds = 20;      ///< frames of each renderer at most
    double seconds = 20;  ///< time for a scene, from the third round on
    Clock clock = Clock::wall;
};

struct Subject {
    std::string scene;
    int threads = 1, samples = 1;
    bool depth_first = false;  ///< llvmpipe draws the depths before the colours
    TextureStorage storage = TextureStorage::rgba16;
    PeerFilter filter = PeerFilter::usual;
    PeerShader shader = PeerShader::usual;
    std::string pictures;  ///< folder for both pictures; empty: none
};

/// Instruction sets of halflit that are measured: AVX2, where it is there, and the widest.
[[nodiscard]] std::vector<Isa> measured_isas();
inline constexpr int kMostIsas = 2;

/// Frames in turn: llvmpipe, then halflit with each of measured_isas().
struct Turns {
    int rounds = 0;
    Spread peer_ms, readback_ms;  ///< a frame of llvmpipe without reading it back; reading it back
    Spread halflit_ms[kMostIsas];
    Spread ratio[kMostIsas];  ///< llvmpipe's time over halflit's, pair by pair
    PictureDifference pictures;
    char reason[200] = "";  ///< why nothing was measured; empty if it was
};
[[nodiscard]] Turns measure_turns(const Subject& subject, const Limits& limits);

/// A process that draws one frame of a scene in memory.
struct FirstFrame {
    double ms = 0;         ///< from the scene in memory to the first picture: for llvmpipe context, shaders and upload included
    double memory_mb = 0;  ///< peak above what the process held before, the scene included
    char reason[200] = "";
};
[[nodiscard]] FirstFrame measure_first_of_peer(const Subject& subject, const Limits& limits);
[[nodiscard]] FirstFrame measure_first_of_halflit(const Subject& subject, const Limits& limits);

}  // namespace halflit::peer
