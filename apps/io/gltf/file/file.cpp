#include "apps/io/gltf/file/file.hpp"

#include <algorithm>
#include <iterator>

namespace halflit::io::detail::file {

int find(const Attributes& attributes, std::string_view name) {
    for (const auto& [attribute, accessor] : attributes)
        if (attribute == name) return accessor;
    return -1;
}

bool is_drawn(std::string_view attribute) {
    static constexpr std::string_view kDrawn[] = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    return std::find(std::begin(kDrawn), std::end(kDrawn), attribute) != std::end(kDrawn);
}

bool is_of_skin(std::string_view attribute) { return attribute.starts_with("JOINTS_") || attribute.starts_with("WEIGHTS_"); }

bool is_of_vertices(std::string_view attribute) {
    return is_drawn(attribute) || is_of_skin(attribute) || attribute.starts_with(kSplatAttributes);
}

bool is_of_instances(std::string_view attribute) { return attribute == "TRANSLATION" || attribute == "ROTATION" || attribute == "SCALE"; }

std::string place_of(TextureSlot slot) {
    std::string place(shading::info_of(slot).gltf);
    std::replace(place.begin(), place.end(), '/', '.');
    return place;
}

const MaterialNumbers& default_numbers() {
    static const MaterialNumbers kDefaults = [] {
        MaterialNumbers numbers{};
        for (std::size_t i = 0; i < shading::kMaterialNumberCount; ++i) {
            float row[4];
            shading::kMaterialNumbers[i].get(halflit::Material{}, row);
            std::copy_n(row, shading::kMaterialNumbers[i].count, &numbers[shading::kFirstFloats[i]]);
        }
        return numbers;
    }();
    return kDefaults;
}

bool File::uses(std::string_view extension) const {
    const auto holds = [&](const auto& list) { return std::find(list.begin(), list.end(), extension) != list.end(); };
    return holds(extensions_used) || holds(extensions_required);
}

}  // namespace halflit::io::detail::file
