// A scene as bytes, for copies and other processes of the same version of the library on machines of one byte order.
#pragma once

#include "apps/c/scene_handle.hpp"

#include <halflit/error.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace halflit::c {

/// All that a scene has but what its animations need. Fails (usage) for an environment whose image was not kept.
[[nodiscard]] Result<std::vector<std::byte>> archived(const halflit_scene& scene);

/// Replaces the scene's content; it keeps what its own animations need. Fails (bad_input), with the scene unchanged, for bytes
/// of another version or that are damaged, and for indices out of range.
[[nodiscard]] Result<void> restore(std::span<const std::byte> bytes, halflit_scene& scene);

}  // namespace halflit::c
