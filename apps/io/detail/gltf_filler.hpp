// Target of the schema's actions: the file as read so far, and the object that is being read.
#pragma once

#include "apps/io/detail/gltf_file.hpp"
#include "apps/io/detail/json_scan.hpp"
#include "apps/io/detail/load_failure.hpp"

#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail {

class GltfFiller {
public:
    GltfFiller(file::File& target, Budget& memory) : file(target), memory_(memory) {}

    file::File& file;
    file::TexturePlace* place = nullptr;                       ///< the texture place that is being read
    std::vector<double> matrix, translation, rotation, scale;  ///< values of the node that is being read

    /// Appends an element. Takes twice its size from the budget, because a growing vector holds two copies for a moment.
    template <class T>
    T& append(std::vector<T>& list, T value = {}) {
        memory_.take(2 * sizeof(T));
        return list.emplace_back(std::move(value));
    }

    /// Returns the text of a string, valid for as long as the file lives.
    std::string_view keep(const JsonValue& value) {
        return value.in_place ? value.text : std::string_view(file.texts.emplace_back(value.text));
    }

    std::string_view key;  ///< key of the value that is being read; lives as long as the file

private:
    Budget& memory_;
};

}  // namespace halflit::io::detail
