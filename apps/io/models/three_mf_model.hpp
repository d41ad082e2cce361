// A model part of a 3MF file: objects with their meshes and colours, and what is built of them.
#pragma once

#include "apps/io/gltf/file/transform.hpp"
#include "apps/io/models/soup.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail::three_mf {

/// A resource that triangles take colours or a texture from.
struct Properties {
    bool is_texture = false;             ///< a texture2dgroup
    std::vector<Vec4f> colors;           ///< linear
    std::vector<Vec2f> uvs;              ///< v points down
    std::uint32_t texture = 0;           ///< id of a texture2d
    std::vector<std::uint32_t> place;    ///< of entries in the list of the object that is made; kNone: not there
    std::vector<std::uint32_t> layers;   ///< of multiproperties: the groups, the lowest first; of composites: the base materials
    std::vector<std::uint32_t> indices;  ///< of composites: entries of the base materials
    bool multiplies = false;             ///< of multiproperties: layers are multiplied instead of laid above each other
};

struct Texture2d {
    std::string path;
    std::string wrap_u = "wrap", wrap_v = "wrap";
};

struct Triangle {
    std::array<std::uint32_t, 3> vertex{}, property{};
    std::uint32_t group = kNone;  ///< id of properties
};

/// Ids of groups that the file does not number: colours of a slicer's filaments.
inline constexpr std::uint32_t kFilaments = kNone - 1;

struct Component {
    std::string path;  ///< of the part; empty: this one
    std::uint32_t object = 0;
    Affine transform;
    bool is_printable = true;
};

/// Struts between vertices, and balls at vertices.
struct Lattice {
    enum class Cap : std::uint8_t { sphere, hemisphere, butt };
    struct Beam {
        std::array<std::uint32_t, 2> vertex{}, property{};
        std::array<double, 2> radius{};
        std::array<Cap, 2> cap{};
        std::uint32_t group = kNone;  ///< id of properties
    };
    struct Ball {
        double radius = 0.0;
        std::uint32_t group = kNone, property = 0;
    };
    std::vector<Beam> beams;
    std::map<std::uint32_t, Ball> balls;  ///< by vertex
    std::vector<std::uint32_t> meshes;    ///< objects that cut it, or stand for it in other programs
    double shortest = 0.0;                ///< of beams that are drawn
    double ball_radius = 0.0;             ///< above 0: of balls at the ends of all beams
};

struct Object {
    std::string name;
    bool is_component = false;                                  ///< of another object
    bool is_support = false;                                    ///< helps to build others, and is none of the model
    std::vector<std::pair<std::uint32_t, std::string>> paints;  ///< triangles that a slicer's user painted, and how
    std::vector<Vec3d> vertices;
    std::vector<Vec3f> normals;  ///< of the last vertices; empty: none has one
    std::vector<Triangle> triangles;
    Lattice lattice;
    std::vector<Component> components;
};

struct Model {
    double metres = 0.001;      ///< length of the unit
    bool is_of_slicer = false;  ///< it declares names of a slicer
    std::map<std::uint32_t, Object> objects;
    std::map<std::uint32_t, Properties> properties;
    std::map<std::uint32_t, Texture2d> textures;
    std::vector<Component> items;  ///< of the build
};

/// "#RRGGBB" or "#RRGGBBAA" in sRGB, as linear light and alpha; blanks may be around it.
[[nodiscard]] std::optional<Vec4f> parse_color(std::string_view text);

}  // namespace halflit::io::detail::three_mf

namespace halflit::io::detail {

class ModelBuilder;

/// Reads a part, whose text it may mend. `where` is its name, for messages. Throws LoadFailure.
[[nodiscard]] three_mf::Model read_three_mf_model(std::span<std::byte> text, const std::string& where, ModelBuilder& builder);

/// Makes triangles of an object's lattice: round struts by their radii and ends, in fewer segments where there are many.
void sweep_lattice(three_mf::Object& object, const std::string& where, ModelBuilder& builder);

}  // namespace halflit::io::detail
