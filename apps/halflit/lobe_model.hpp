// Lobes by name in double, for reports whose numbers are compared with closed forms. Rendering takes them from io::lobe_from_name, in
// float.
#pragma once

#include "halflit/error.hpp"
#include "sh/zonal.hpp"

#include <optional>
#include <string>

namespace halflit::cli {

struct LobeModelOptions {
    std::string name;
    std::optional<double> wrap, power;  ///< empty: the value that the name stands for
    std::optional<bool> normalize;
};

struct LobeModel {
    std::string name;
    sh::WrapLobe lobe;
};

/// Wrap w in [0, 1]; the error says why another value is refused.
[[nodiscard]] Result<double> parse_wrap(const std::string& text);
/// Power n in [0, 10000].
[[nodiscard]] Result<double> parse_power(const std::string& text);

[[nodiscard]] Result<LobeModel> make_lobe_model(const LobeModelOptions& options);

}  // namespace halflit::cli
