// Formats that a program of its own turns into glTF (docs/formats.md#importers).
#pragma once

#include "apps/io/models/model_readers.hpp"
#include "halflit/model.hpp"

#include <optional>
#include <string_view>

namespace halflit::io::detail {

/// STEP, IGES and BREP by halflit-import-cad; nothing: there is no such program. In millimetres, with z up. Throws LoadFailure.
[[nodiscard]] std::optional<LoadedScene> read_cad(const ModelFile& file, const LoadOptions& options);
/// A file whose name has the extension of one of LoadOptions::importers; nothing: it has none of them. Throws LoadFailure.
[[nodiscard]] std::optional<LoadedScene> read_by_importer(const ModelFile& file, const LoadOptions& options);

}  // namespace halflit::io::detail
