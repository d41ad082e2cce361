// The word that was probably meant by one that is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace halflit::engine {

/// The candidate that differs from `word` by the fewest typing errors (characters inserted, left out, replaced, or two exchanged); empty if
/// none is near enough.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// " (did you mean WORD?)", or nothing if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace halflit::engine
