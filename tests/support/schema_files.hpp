// glTF files made from the rows of the loader's schema: one index of a small scene is out of range. A new row of the schema has its files
// without further work.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace halflit::test {

/// An index of a glTF file, as a row of the schema gives it.
struct IndexRow {
    std::string path;     ///< "nodes/#/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION"; '#': an element
    std::string place;    ///< the same in messages: "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION"
    bool stored = false;  ///< the loader keeps it
};

/// All indices of the schema. A member with a free name comes once for each name that some reader reads, and once for one that none does.
[[nodiscard]] std::vector<IndexRow> index_rows();

/// A scene in which every array has three elements and the drawn nodes use the first of each.
[[nodiscard]] nlohmann::json scene_of_all_arrays();

/// Sets the value at a row's path, at the first element of each array, and what the schema requires beside it.
void put(nlohmann::json& scene, const IndexRow& row, const nlohmann::json& value);

}  // namespace halflit::test
