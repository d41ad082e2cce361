// The program's test of itself: small built-in scenes, drawn by every instruction set of this machine, against hashes that are built in.
#pragma once

#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/program/engine.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace halflit::cli {

struct SelfTestScene {
    const char* name;
    const char* scene;       ///< a built-in one
    const char* flags;       ///< of halflit render, with blanks between them
    std::uint64_t expected;  ///< pixel_hash of the picture's 8-bit codes
};

/// The rows of self_test_scenes.def.
[[nodiscard]] std::span<const SelfTestScene> self_test_scenes();

struct SelfTest {
    std::string text;  ///< the build and the machine, then a line for each scene
    bool passed = true;
};

/// Draws each scene by each instruction set that is built in and that this processor has. A scene that cannot be drawn does not pass.
[[nodiscard]] SelfTest run_self_test(std::span<const SelfTestScene> scenes);

}  // namespace halflit::cli
