// Results of the peer bench as a table for readers and as CSV.
#pragma once

#include "bench/peer/measure.hpp"

#include <string>
#include <vector>

namespace halflit::peer {

struct TurnsRow {
    Subject subject;
    Turns turns;
};
struct FirstRow {
    Subject subject;
    FirstFrame cold, warm;  ///< llvmpipe without and with its shaders in the cache on disk
    FirstFrame halflit;
};

/// Largest share of pixels that may differ by more than 2 codes. With several samples, a triangle that covers some of a pixel but not its
/// centre is textured differently: llvmpipe extrapolates the coordinates to the centre, halflit keeps them inside the triangle.
inline constexpr double kMostAbove2 = 0.001, kMostAbove2OfSamples = 0.1;
/// Largest share of pixels of data sets whose triangle, depth or point may differ; none of them may be an inner pixel. With several samples
/// llvmpipe's points are those of the first sample. halflit's are the pixel's centre, or lie beside it where the triangle does not hold it;
/// these differ in as many pixels as colours.
inline constexpr double kMostOther = 0.002;
/// True if all of this is kept, colours only if the filter is one that gives the same picture.
[[nodiscard]] bool pictures_agree(const TurnsRow& row);

void print_turns_head(const std::vector<Isa>& isas);
void print_turns(const TurnsRow& row, const std::vector<Isa>& isas);
/// Geometric means of the ratios over all scenes but data sets, for each number of threads and samples.
void print_means(const std::vector<TurnsRow>& rows, const std::vector<Isa>& isas);
void print_first_head();
void print_first(const FirstRow& row);

/// Writes peer_MACHINE.csv and peer_first_MACHINE.csv, with a column for each member. False if a file cannot be written.
[[nodiscard]] bool write_csv(const std::string& folder, const std::vector<TurnsRow>& turns, const std::vector<FirstRow>& first,
                             const std::vector<Isa>& isas);

}  // namespace halflit::peer
