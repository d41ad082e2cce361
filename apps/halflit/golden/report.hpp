// Results of `halflit golden` as JSON, as a page, and as JUnit XML.
#pragma once

#include "apps/halflit/golden/check.hpp"

#include <string>
#include <vector>

namespace halflit::cli {

/// The report's keys after its head: {"passed", "sums", "scenes"}.
[[nodiscard]] Json golden_json(const std::vector<GoldenResult>& results);

/// A page with what differs first: expected, actual and difference pictures side by side. It refers to files beside it only.
[[nodiscard]] std::string golden_page(const GoldenList& list, const std::vector<GoldenResult>& results);

/// One test case for each scene. A scene that cannot be drawn is an error, one that differs is a failure.
[[nodiscard]] std::string golden_junit(const std::vector<GoldenResult>& results);

}  // namespace halflit::cli
