// halflit: the command line. Parses, dispatches, and turns errors into one line and an exit code.
#include "apps/halflit/commands.hpp"
#include "apps/halflit/interrupt.hpp"
#include "apps/halflit/messages.hpp"
#include "apps/halflit/usage_error.hpp"
#include "halflit/version.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>

namespace {

using namespace halflit;
using namespace halflit::cli;

/// Opens /dev/null for each closed standard stream. Otherwise the next file opened would get that stream's number, and messages would be
/// written into it.
void occupy_standard_streams() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        // Opened for the opposite direction, so that reading from or writing to the closed stream stays an error.
        if (::fcntl(fd, F_GETFD) == -1) (void)::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int run(const Command& command) {
    try {
        const Result<int> result = command.run();
        if (result) return *result;
        print_error(result.error().message);
        return static_cast<int>(result.error().code);
    } catch (const std::bad_alloc&) {
        print_error("out of memory");
        return static_cast<int>(ErrorCode::limit);
    }
}

int parse_and_run(int argc, char** argv) {
    CLI::App root("Renders glTF models to pictures on the CPU.", "halflit");
    root.footer(
        "Run 'halflit COMMAND --help' for the flags of a command.\n"
        "Exit codes: 0 ok, 1 negative result, 2 usage, 3 bad input, 4 cannot read or write, 5 limit hit, 6 internal error, 128+n signal "
        "n.");
    root.require_subcommand(1);
    root.set_version_flag("--version", fmt::format("halflit {} (pixel_epoch {})", version(), kPixelEpoch));
    const Command commands[] = {add_render_command(root), add_bench_command(root), add_info_command(root),    add_diff_command(root),
                                add_lobe_command(root),   add_env_command(root),   add_figures_command(root), add_trade_command(root)};
    try {
        root.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            root.exit(error);  // --help and --version
            return std::fflush(stdout) == 0 ? 0 : static_cast<int>(ErrorCode::io);
        }
        print_error(usage_message(root, error));
        return static_cast<int>(ErrorCode::usage);
    }
    for (const Command& command : commands)
        if (command.app->parsed()) return run(command);
    return static_cast<int>(ErrorCode::internal);
}

}  // namespace

int main(int argc, char** argv) {
    occupy_standard_streams();
    handle_signals();
    try {
        return parse_and_run(argc, argv);
    } catch (const std::exception& exception) {
        print_error(std::string("internal error: ") + exception.what());
        return static_cast<int>(ErrorCode::internal);
    }
}
