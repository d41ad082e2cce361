// Textures of the trials.
#pragma once

#include "halflit/material.hpp"
#include "tests/adversary/genome.hpp"
#include "tests/adversary/trial.hpp"

#include <memory>

namespace halflit::adversary {

/// Genes that one use of a texture reads.
inline constexpr int kTextureGenes = 16;

/// A texture and how it is used. Null if the genes say none.
[[nodiscard]] std::shared_ptr<const Picture> some_texture(Genes& genes, TextureSlot slot, AvoidSet avoid, TextureUse& use);

}  // namespace halflit::adversary
