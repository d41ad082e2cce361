// A CodeTexture with its levels, as the kernels read it.
#pragma once

#include "halflit/fixed_function.hpp"
#include "raster/kernels/fixed_function_args.hpp"

#include <vector>

namespace halflit::raster {

class CodeLevelsData {
public:
    /// Requires: sizes as the texture says.
    explicit CodeLevelsData(const CodeTexture& texture);
    CodeLevelsData(CodeLevelsData&&) noexcept = default;
    [[nodiscard]] const CodeLevels& levels() const { return levels_; }

private:
    std::vector<std::int32_t> texels_;
    CodeLevels levels_{};
};

}  // namespace halflit::raster
