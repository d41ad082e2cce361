// Lobes by name in double, for reports whose numbers are compared with closed forms. Rendering takes them from io::lobe_from_name, in
// float.
#pragma once

#include "halflit/error.hpp"
#include "sh/zonal.hpp"

#include <optional>
#include <string>
#include <vector>

namespace halflit::engine {

struct LobeModelOptions {
    std::string name;
    std::optional<double> wrap, power;  ///< empty: the value that the name stands for
    std::optional<bool> normalize;
};

struct LobeModel {
    std::string name;
    sh::WrapLobe lobe;
};

/// All names, in the order of lobe_names().
[[nodiscard]] std::vector<std::string> lobe_name_list();
/// " (did you mean NAME?)", or nothing if `name` is a lobe or none is spelled alike.
[[nodiscard]] std::string did_you_mean_lobe(const std::string& name);

/// Wrap w in [0, 1]; the error says why another value is refused.
[[nodiscard]] Result<double> parse_wrap(const std::string& text);
/// Power n in [0, 10000].
[[nodiscard]] Result<double> parse_power(const std::string& text);

[[nodiscard]] Result<LobeModel> make_lobe_model(const LobeModelOptions& options);

}  // namespace halflit::engine
