// Drawings of filled shapes and lines, as files of vectors: SVG and PDF.
#pragma once

#include "apps/engine/pictures/canvas.hpp"

#include <span>
#include <string>
#include <vector>

namespace halflit::engine {

enum class VectorFormat { none, svg, pdf };

/// By the ending of a file's name; none: of another format.
[[nodiscard]] VectorFormat vector_format_of(const std::string& path);

/// The file of a page of width x height pixels, 1/96 inch each, on white. Shapes with one layer that follow each other are a group with its
/// name.
[[nodiscard]] std::string vector_file(VectorFormat format, std::span<const VectorShape> shapes, int width, int height);

/// Parts of lines that end in one point, where no third one ends, joined to long ones.
[[nodiscard]] std::vector<Contour> joined_lines(std::span<const std::pair<Point, Point>> parts);

}  // namespace halflit::engine
