// The comparison of two models, for the command and for agents.
#pragma once

#include "apps/engine/compare/comparison.hpp"
#include "apps/engine/compare/model_pair.hpp"

#include <vector>

namespace halflit::engine {

/// Flags of a picture that count for a comparison, and --max. `options` must outlive what this returns.
[[nodiscard]] std::vector<FlagGroup> compare_flags(CompareOptions& options);

/// Loads both models, draws each view of both, and compares models and views.
[[nodiscard]] Result<Comparison> compare_files(const CompareOptions& options);

}  // namespace halflit::engine
