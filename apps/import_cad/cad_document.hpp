// CAD files by OpenCASCADE: shapes with names, colours and places, and their triangles.
#pragma once

#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::cad {

/// A file that cannot be read, with the reason in one line.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class Format : std::uint8_t { step, iges, brep };

/// By the file's first bytes; nothing: none of these.
[[nodiscard]] std::optional<Format> find_format(std::string_view bytes);

/// Triangles of one colour, of one face behind the other, or lines of edges that no face has.
struct Patch {
    std::optional<std::array<float, 4>> color;  ///< linear; none: the file has none
    std::vector<float> positions, normals;      ///< three each, in millimetres; normals are those of the surfaces
    std::vector<float> faces;                   ///< for each vertex the number of its face in the shape, from 0
    std::vector<std::uint32_t> indices;         ///< three for each triangle, two for each line
    bool is_lines = false;                      ///< without normals and faces
};

struct Shape {
    std::string name;  ///< may be empty
    std::vector<Patch> patches;
};

struct Node {
    std::string name;  ///< may be empty
    int parent = -1;   ///< comes before its children; -1: none
    int shape = -1;    ///< index into Document::shapes; -1: an assembly
    TopLoc_Location parent_from_node;
};

/// Of one node that has a shape, where it is placed.
struct Measures {
    int node;                     ///< index into Document::nodes
    std::array<double, 6> box;    ///< least and largest corner, millimetres
    double area = 0, volume = 0;  ///< of its faces and of its solids, square and cubic millimetres
    int solids = 0;
};

struct Document {
    std::vector<Node> nodes;
    std::vector<Shape> shapes;          ///< each once, whatever the number of its nodes
    std::vector<Measures> measures;     ///< if they were asked for
    std::vector<std::string> warnings;  ///< what the file has and the document lacks, one line each
};

/// The file's shapes, as triangles so fine that none is farther from its surface than a quarter of a pixel where the diagonal of the
/// model's box takes `pixels` of them. measure: with Document::measures. Throws Refused, and OpenCASCADE's exceptions.
[[nodiscard]] Document read_document(const std::string& bytes, Format format, double pixels, bool measure);

}  // namespace halflit::cad
