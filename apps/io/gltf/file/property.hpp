// Properties of a glTF file that animations write, by their JSON pointers.
#pragma once

#include "apps/io/gltf/file/file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace halflit::io::detail {

/// Part of a scene that a property decides.
enum class Part : std::uint8_t { transform, weights, visibility, material, light, camera };

struct Property {
    std::string_view list, path;  ///< "/nodes", then an index, then "/translation"
    Part part;
    std::size_t count;  ///< numbers; 0: as many as there are morph targets
    /// The numbers of an element of the list; null: it does not have them.
    double* (*at)(file::File& file, std::size_t element);
};

/// Where an animation writes.
struct Slot {
    const Property* property = nullptr;
    int element = -1;  ///< of the property's list
    int place = -1;    ///< a TextureSlot; -1: the property is not one of a texture
    std::size_t count = 0;

    [[nodiscard]] Part part() const { return property->part; }
    [[nodiscard]] bool is_rotation() const;  ///< a quaternion
    [[nodiscard]] bool is_truth() const { return part() == Part::visibility; }
};

/// The slot of a pointer such as "/nodes/3/translation"; its count is not set for weights. Nothing if there is no such property, or no such
/// element.
[[nodiscard]] std::optional<Slot> find_slot(const file::File& file, std::string_view pointer);
/// The slot of a node's "translation", "rotation", "scale" or "weights".
[[nodiscard]] std::optional<Slot> node_slot(const file::File& file, int node, std::string_view path);

/// The numbers of a slot: slot.count of them. Null: the file does not have them.
[[nodiscard]] double* locate(file::File& file, const Slot& slot);

}  // namespace halflit::io::detail
