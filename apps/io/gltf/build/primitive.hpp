// One glTF primitive as a mesh: indices of any kind become lists of triangles, lines or points, attributes of any type become floats.
#pragma once

#include "apps/io/gltf/build/deform.hpp"
#include "apps/io/gltf/codecs/splat_cloud.hpp"
#include "apps/io/gltf/file/accessor.hpp"
#include "halflit/mesh.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace halflit::io::detail {

/// Types that an attribute may have.
struct AttributeRule {
    const char* name;
    int min_components, max_components;
    std::span<const Component> plain, normalized;            ///< component types that glTF 2.0 allows
    std::span<const Component> more_plain, more_normalized;  ///< and those that KHR_mesh_quantization adds
};

struct ReadMesh {
    MeshSource source;                           ///< without joints, and without what its material requires
    std::vector<std::uint32_t> source_vertices;  ///< the file's vertex number of each vertex
    std::string where;                           ///< "meshes[0].primitives[1]", for messages
};

class PrimitiveReader {
public:
    PrimitiveReader(Document& document, const std::vector<Accessor>& accessors);

    /// Reads a primitive; empty if there is nothing to draw (no positions, no triangles). morph_weights: targets with the
    /// weight 0 are not read; it may be empty.
    std::optional<ReadMesh> read(std::size_t mesh, std::size_t primitive, std::span<const double> morph_weights);

    /// The accessor of an attribute in `list` ("meshes[0].primitives[1].attributes"), or null if there is none, or if its type or its
    /// count is wrong. Throws for that by the strict rules, and where `count` is not known.
    [[nodiscard]] const Accessor* attribute(const std::string& list, const file::Attributes& attributes, const AttributeRule& rule,
                                            std::optional<std::size_t> count);

private:
    const Accessor* checked_attribute(const std::string& list, const file::Attributes& attributes, const AttributeRule& rule,
                                      std::optional<std::size_t> count);
    void warn_of_layout(const std::string& where, int accessor);
    std::vector<std::uint32_t> list_indices(const file::Primitive& primitive, const std::string& where, std::size_t vertex_count);
    std::vector<std::uint32_t> gather_vertices(std::vector<std::uint32_t>& indices, std::size_t vertex_count);
    /// Makes the points splats, if they have the attributes of KHR_gaussian_splatting.
    void read_splats(const file::Primitive& primitive, const std::string& list, const Accessor& position, ReadMesh& out);
    void take_splats(SplatCloud&& cloud, const file::Primitive& primitive, ReadMesh& out);
    void read_targets(const file::Primitive& primitive, std::size_t vertex_count, std::span<const double> weights, ReadMesh& out);

    Document& document_;
    const std::vector<Accessor>& accessors_;
    bool quantized_ = false;
    std::map<int, Accessor> normalized_;                      // of integers that should be
    std::unordered_map<std::size_t, int> attribute_of_view_;  // the first accessor of vertices in each bufferView
    std::vector<std::uint32_t> new_number_, stamp_of_;        // indexed by the file's vertex; a number is valid if its stamp is stamp_
    std::uint32_t stamp_ = 0;
};

}  // namespace halflit::io::detail
