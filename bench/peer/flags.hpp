// Flags of the peer bench.
#pragma once

#include "bench/peer/measure.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::peer {

struct Flags {
    std::vector<std::string> scenes;  ///< all by default
    std::vector<int> threads{1, 2}, samples{1, 4};
    Limits limits;
    TextureStorage storage = TextureStorage::rgba16;
    PeerFilter filter = PeerFilter::usual;
    PeerShader shader = PeerShader::usual;
    bool first = true;  ///< measure first frames too
    std::string pictures, glb, csv;
};

/// Nothing, with the usage printed, for --help or a flag that is not understood; `code` is then the exit code.
[[nodiscard]] std::optional<Flags> read_flags(int argc, char** argv, int& code);

}  // namespace halflit::peer
