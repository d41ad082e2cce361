// The result of a comparison, and its reports.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/compare/model_change.hpp"
#include "apps/engine/compare/view_change.hpp"

#include <string>
#include <vector>

namespace halflit::engine {

struct Comparison {
    std::string a, b;  ///< names of the files
    std::string unit;  ///< of length, that of the first file; empty: the files have none
    int max_codes = 0;
    double scale = 1;  ///< units of the drawn world in one of the file's
    std::vector<ViewChange> views;
    ModelChange models;
    std::vector<std::string> warnings;

    [[nodiscard]] std::uint64_t changed_pixels() const;
    [[nodiscard]] bool differs() const { return changed_pixels() > 0 || models.differs(); }
    /// Width of a pixel, and the step in depth of a surface that faces the view, in the file's unit: the largest of the views.
    [[nodiscard]] double pixel() const;
    [[nodiscard]] double depth() const;
};

[[nodiscard]] Json comparison_json(const Comparison& comparison);

/// Some lines for a terminal.
[[nodiscard]] std::string comparison_text(const Comparison& comparison);

/// A comment for a pull request: a line of verdict, the picture, and tables. picture: its path relative to the comment; empty: none.
[[nodiscard]] std::string comparison_markdown(const Comparison& comparison, const std::string& picture);

/// A page that holds its pictures.
[[nodiscard]] Result<std::string> comparison_page(const Comparison& comparison);

/// A picture of all views: in each row A, B, and what changed.
[[nodiscard]] Result<Image> comparison_sheet(const Comparison& comparison);

}  // namespace halflit::engine
