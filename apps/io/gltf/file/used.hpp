// The elements of a file that its drawn nodes use. A fault of another element does not touch the picture.
#pragma once

#include "apps/io/gltf/file/animation_use.hpp"
#include "apps/io/gltf/file/target.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace halflit::io::detail {

class Used {
public:
    [[nodiscard]] bool has(Target target, std::size_t element) const {
        const std::vector<bool>& list = of_[static_cast<std::size_t>(target)];
        return element < list.size() && list[element];
    }

    /// Takes an element out.
    void drop(Target target, std::size_t element) { of_[static_cast<std::size_t>(target)][element] = false; }

    /// Adds an element behind the file's own.
    void add(Target target, std::size_t element) {
        std::vector<bool>& list = of_[static_cast<std::size_t>(target)];
        if (list.size() <= element) list.resize(element + 1);
        list[element] = true;
    }

private:
    friend class UseFinder;
    std::array<std::vector<bool>, kTargets> of_;
};

/// Follows the references from the drawn nodes, and from the animations that pose them. An index that is out of range is left out.
[[nodiscard]] Used find_used(const file::File& file, const AnimationUse& animations, std::span<const int> drawn_nodes,
                             std::span<const int> parents);

}  // namespace halflit::io::detail
