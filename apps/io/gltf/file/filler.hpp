// Target of the schema's actions: the file as read so far, and the object that is being read.
#pragma once

#include "apps/io/files/load_failure.hpp"
#include "apps/io/gltf/file/file.hpp"
#include "apps/io/gltf/file/notes.hpp"
#include "apps/io/gltf/text/json_scan.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail {

class GltfFiller {
public:
    GltfFiller(file::File& target, Notes& found, Budget& memory) : file(target), notes(found), memory_(memory) {}

    file::File& file;
    Notes& notes;
    Owner owner;                                               ///< element that is being read
    file::TexturePlace* place = nullptr;                       ///< the texture place that is being read
    std::size_t component = 0;                                 ///< number of the value in its object or array
    std::vector<double> matrix, translation, rotation, scale;  ///< values of the node that is being read
    /// Places in the text, of the element that is being read.
    std::size_t matrix_offset = 0, rotation_offset = 0, spot_offset = 0;
    std::size_t perspective_offset = 0, orthographic_offset = 0, perspective_zfar = 0, orthographic_zfar = 0;

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

    /// Notes that the value at `offset` is taken otherwise than it says.
    void warn(std::size_t offset, std::string what, std::string instead) {
        notes.add_warning({offset, owner, std::move(what), std::move(instead)});
    }

    /// Notes a fault of the element that is being read.
    void fault(std::size_t offset, std::string what) { notes.add_fault(memory_, {offset, owner, std::move(what), {}}); }

    std::string_view key;  ///< key of the value that is being read; lives as long as the file

private:
    Budget& memory_;
};

}  // namespace halflit::io::detail
