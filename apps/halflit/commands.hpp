// The sub-commands. Each adds itself to the command line and returns the function that runs it.
#pragma once

#include "halflit/error.hpp"

#include <functional>

namespace CLI {
class App;
}

namespace halflit::cli {

struct Command {
    CLI::App* app = nullptr;
    std::function<Result<int>()> run;  ///< the exit code: 0, or 1 for a negative result
};

[[nodiscard]] Command add_render_command(CLI::App& root);
[[nodiscard]] Command add_bench_command(CLI::App& root);
[[nodiscard]] Command add_info_command(CLI::App& root);
[[nodiscard]] Command add_diff_command(CLI::App& root);
[[nodiscard]] Command add_lobe_command(CLI::App& root);
[[nodiscard]] Command add_env_command(CLI::App& root);
[[nodiscard]] Command add_figures_command(CLI::App& root);
[[nodiscard]] Command add_trade_command(CLI::App& root);

}  // namespace halflit::cli
