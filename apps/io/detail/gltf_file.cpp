#include "apps/io/detail/gltf_file.hpp"

#include <algorithm>

namespace halflit::io::detail::file {

int find(const Attributes& attributes, std::string_view name) {
    for (const auto& [attribute, accessor] : attributes)
        if (attribute == name) return accessor;
    return -1;
}

bool File::uses(std::string_view extension) const {
    const auto holds = [&](const auto& list) { return std::find(list.begin(), list.end(), extension) != list.end(); };
    return holds(extensions_used) || holds(extensions_required);
}

}  // namespace halflit::io::detail::file
