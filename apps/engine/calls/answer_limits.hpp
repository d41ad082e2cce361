// Answers that an agent can read: long lists are cut, and what is left out is counted.
#pragma once

#include "apps/engine/answers/run_report.hpp"

#include <cstddef>
#include <string>

namespace halflit::engine {

inline constexpr std::size_t kMostAnsweredBytes = 60'000;  ///< of a report as JSON without spaces
inline constexpr std::size_t kMostNotesBytes = 20'000;     ///< of the lines before it

/// A report of at most so many bytes. If it has more, no list keeps more than so many items, the same number for all: 10000, 5000, 2000 and
/// so on down to 1, and then the largest members go. Lists of up to 16 numbers, such as points and matrices, stay whole, and texts keep 500
/// bytes. What is left out is counted by "left_out": [{"list": JSON pointer, "items": count}], as docs/answers/answer.txt has it.
[[nodiscard]] Json bounded_report(Json report, std::size_t most_bytes = kMostAnsweredBytes);

/// The first lines that have at most so many bytes. A last line says how many are left out.
[[nodiscard]] std::string bounded_lines(std::string lines, std::size_t most_bytes = kMostNotesBytes);

}  // namespace halflit::engine
