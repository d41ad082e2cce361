// Models that tests write to files and change: a sphere and a box as lists of triangles, in STL and OFF.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace halflit::test {

using Corner = std::array<double, 3>;
using Corners = std::array<Corner, 3>;  ///< of a triangle, counter-clockwise from outside

/// A sphere of radius 1 around the origin: 32 rows from pole to pole along z, 48 columns. The vertex on +x is at `pulled`, 1: on the
/// sphere.
inline std::vector<Corners> sphere_with_spike(double pulled) {
    constexpr int kRows = 32, kColumns = 48;
    constexpr double kPi = 3.14159265358979323846;
    const auto vertex = [&](int row, int column) -> Corner {
        const double down = kPi * row / kRows, around = 2 * kPi * (column % kColumns) / kColumns;
        const double radius = row == kRows / 2 && column % kColumns == 0 ? pulled : 1.0;
        return {radius * std::sin(down) * std::cos(around), radius * std::sin(down) * std::sin(around), radius * std::cos(down)};
    };
    std::vector<Corners> triangles;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const Corner a = vertex(row, column), b = vertex(row, column + 1), c = vertex(row + 1, column), d = vertex(row + 1, column + 1);
            if (row > 0) triangles.push_back({a, c, b});
            if (row < kRows - 1) triangles.push_back({b, c, d});
        }
    return triangles;
}

/// The twelve triangles of a box; two by two its sides -x, +x, -y, +y, -z, +z.
inline std::vector<Corners> box(Corner low, Corner high) {
    std::vector<Corners> triangles;
    const auto corner = [&](int i) -> Corner { return {i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]}; };
    constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& side : kSides) {
        triangles.push_back({corner(side[0]), corner(side[1]), corner(side[2])});
        triangles.push_back({corner(side[0]), corner(side[2]), corner(side[3])});
    }
    return triangles;
}

inline std::string point_text(const char* before, const Corner& p) {
    char text[128];
    std::snprintf(text, sizeof text, "%s%.9g %.9g %.9g\n", before, p[0], p[1], p[2]);
    return text;
}

inline std::string stl_of(const std::vector<Corners>& triangles) {
    std::string text = "solid\n";
    for (const Corners& triangle : triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const Corner& p : triangle) text += point_text("vertex ", p);
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

/// Each triangle has vertices of its own.
inline std::string off_of(const std::vector<Corners>& triangles) {
    std::string text = "OFF\n" + std::to_string(3 * triangles.size()) + " " + std::to_string(triangles.size()) + " 0\n";
    for (const Corners& triangle : triangles)
        for (const Corner& p : triangle) text += point_text("", p);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        text += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + "\n";
    return text;
}

}  // namespace halflit::test
