// Measurements of one scene: frames of llvmpipe and of halflit in turn, and the first frame of a process.
#pragma once

#include "bench/peer/child.hpp"
#include "bench/peer/compare.hpp"
#include "bench/peer/gl_scene.hpp"
#include "bench/peer/planes.hpp"

#include <string>
#include <vector>

namespace halflit::peer {

struct Limits {
    int width = 0, height = 0;  ///< pixels; 0: those of limits_for()
    int rounds = 20;            ///< frames of each renderer at most
    double seconds = 20;        ///< time for a scene, from the third round on
    int views = 1000;           ///< of each data set
    Clock clock = Clock::wall;
};

/// The limits with a size: 1920 x 1080, or 256 x 256 for data sets, unless they have one.
[[nodiscard]] Limits limits_for(std::string_view scene, Limits limits);

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
    /// A frame of llvmpipe, and reading it back. The first includes the second in a data set, whose planes halflit has in memory.
    Spread peer_ms, readback_ms;
    Spread halflit_ms[kMostIsas];
    Spread ratio[kMostIsas];  ///< llvmpipe's time over halflit's, pair by pair
    PictureDifference pictures;
    PlanesDifference planes;  ///< of data sets
    char reason[200] = "";    ///< why nothing was measured; empty if it was
};
/// Frames of one view.
[[nodiscard]] Turns measure_turns(const Subject& subject, const Limits& limits);
/// Views of a data set. A turn is ten views, of whose last one the pictures and planes are compared.
[[nodiscard]] Turns measure_dataset(const Subject& subject, const Limits& limits);

/// Times of the turns, milliseconds, as they are measured.
class TurnTimes {
public:
    /// halflit_ms: by the index in measured_isas().
    void add(double peer_ms, double readback_ms, const double (&halflit_ms)[kMostIsas]);
    void write_to(Turns& turns) const;

private:
    std::vector<double> peer_ms_, readback_ms_, halflit_ms_[kMostIsas], ratio_[kMostIsas];
};

/// Writes a picture of each renderer into the subject's folder. Does nothing if it has none.
[[nodiscard]] Result<void> write_pictures(const Subject& subject, const Limits& limits, const std::vector<std::uint8_t>& peer,
                                          const std::vector<std::uint8_t>& ours);

/// A process that draws one frame of a scene in memory.
struct FirstFrame {
    double ms = 0;         ///< from the scene in memory to the first picture: for llvmpipe context, shaders and upload included
    double memory_mb = 0;  ///< peak above what the process held before, the scene included
    char reason[200] = "";
};
[[nodiscard]] FirstFrame measure_first_of_peer(const Subject& subject, const Limits& limits);
[[nodiscard]] FirstFrame measure_first_of_halflit(const Subject& subject, const Limits& limits);

}  // namespace halflit::peer
