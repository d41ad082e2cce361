#include "apps/io/gltf/build/instancing.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/file/node_transform.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace halflit::io::detail {

namespace {

constexpr Component kPlaceFloat[] = {Component::f32}, kPlaceSigned[] = {Component::i8, Component::i16};
// The extension normalises rotations alone; other files have all three.
constexpr AttributeRule kPlaceTranslation{"TRANSLATION", 3, 3, kPlaceFloat, kPlaceSigned, {}, {}};
constexpr AttributeRule kPlaceRotation{"ROTATION", 4, 4, kPlaceFloat, kPlaceSigned, {}, {}};
constexpr AttributeRule kPlaceScale{"SCALE", 3, 3, kPlaceFloat, kPlaceSigned, {}, {}};

void read_doubles(const Accessor* accessor, std::size_t index, double* to) {
    if (accessor == nullptr) return;
    float value[4];
    accessor->read_floats(index, value);
    for (int i = 0; i < accessor->components(); ++i) to[i] = static_cast<double>(value[i]);
}

}  // namespace

Affine InstancePlaces::at(std::size_t instance) const {
    file::Transform transform;
    read_doubles(translation, instance, transform.translation);
    read_doubles(rotation, instance, transform.rotation);
    read_doubles(scale, instance, transform.scale);
    return node_transform(transform);
}

InstancePlaces read_instance_places(Document& document, PrimitiveReader& reader, std::size_t node) {
    const file::Node& source = document.file.nodes[node];
    const file::Attributes& attributes = document.file.instancings[static_cast<std::size_t>(source.instancing)];
    const std::string list = fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing.attributes", node);
    InstancePlaces places;
    std::optional<std::size_t> count;
    for (const auto& [rule, to] : {std::pair{&kPlaceTranslation, &places.translation}, std::pair{&kPlaceRotation, &places.rotation},
                                   std::pair{&kPlaceScale, &places.scale}}) {
        *to = reader.attribute(list, attributes, *rule, count);
        if (*to != nullptr) count = (*to)->count();
    }
    for (const auto& [name, accessor] : attributes)
        if (name != kPlaceTranslation.name && name != kPlaceRotation.name && name != kPlaceScale.name)
            document.warn(fmt::format("{}.{}: is left out", list, printable(name, 40)));
    if (!count) document.warn(fmt::format("{}: has no TRANSLATION, ROTATION or SCALE, drawn once", list));
    if (source.skin >= 0) document.warn(fmt::format("{}: the node has a skin, so its instances lie at one place; drawn once", list));
    places.count = source.skin >= 0 ? 1 : count.value_or(1);
    return places;
}

}  // namespace halflit::io::detail
