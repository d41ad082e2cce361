// A trial as files that `halflit render` draws: a .glb, and an .hdr for an environment.
#pragma once

#include "tests/adversary/trial.hpp"

#include <string>

namespace halflit::adversary {

/// Writes PATH.glb, and PATH.hdr if there is an environment. Returns the flags that draw it as the trial does, file names included, and
/// after " # " what the files cannot hold. The genome alone gives the scene bit for bit.
[[nodiscard]] Result<std::string> write_trial(const Trial& trial, const std::string& path);

}  // namespace halflit::adversary
