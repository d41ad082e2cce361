// halflit: the command line. Parses, dispatches, and turns errors into one line and an exit code.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/flags/command_line.hpp"
#include "apps/halflit/flags/help_text.hpp"
#include "apps/halflit/golden/self_test.hpp"
#include "apps/halflit/program/interrupt.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/terminal.hpp"
#include "apps/io/platform/process.hpp"
#include "apps/io/platform/streams.hpp"
#include "halflit/version.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

namespace {

using namespace halflit;
using namespace halflit::cli;

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

int print(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return std::fflush(stdout) == 0 ? 0 : static_cast<int>(ErrorCode::io);
}

/// `halflit SCENE` is `halflit render SCENE`; its flags may come first.
bool means_render(const std::vector<std::string>& arguments) {
    if (arguments.empty()) return false;
    const std::string& first = arguments[0];
    if (is_command(first)) return false;
    if (first == "--") return true;
    if (!first.starts_with('-') || first == "-") return is_scene(first) || is_folder(first);  // a folder: for its message
    // A command after flags gets its message. A word right behind a flag may be the flag's value.
    for (std::size_t i = 1; i < arguments.size(); ++i)
        if (is_command(arguments[i]) && !is_scene(arguments[i]) && !arguments[i - 1].starts_with('-')) return false;
    const std::string name = first.substr(0, first.find('='));
    const std::vector<Command> render = commands_for("render");
    for (const Flag* flag : flags_of(render.front()))
        for (const std::string& spelling : words_of(flag->names, ','))
            if (spelling == name || (spelling.size() == 2 && name.starts_with(spelling)))
                return std::any_of(arguments.begin() + 1, arguments.end(), is_scene);
    return false;
}

/// Threads with less of a stack would end in a fault of memory.
constexpr std::size_t kLeastStack = std::size_t{256} << 10;

int parse_and_run(int argc, char** argv) {
    if (const std::size_t stack = platform::stack_limit(); stack > 0 && stack < kLeastStack) {
        print_error("the limit of stacks is " + std::to_string(stack >> 10) + " KiB (ulimit -s), expected at least 256");
        return static_cast<int>(ErrorCode::limit);
    }
    std::vector<std::string> arguments = platform::arguments(argc, argv);
    if (arguments.empty() && platform::is_terminal(platform::Stream::output))
        return print(program_help(all_commands(), false, help_width()));
    if (means_render(arguments)) arguments.insert(arguments.begin(), "render");
    const std::vector<Command> commands = commands_for(arguments.empty() ? std::string() : arguments[0]);
    const auto line = parse_command_line(commands, std::move(arguments));
    if (!line) {
        print_error(line.error().message);
        return static_cast<int>(line.error().code);
    }
    switch (line->wanted) {
        case ParsedLine::Wanted::run:
            return run(*line->command);
        case ParsedLine::Wanted::version:
        case ParsedLine::Wanted::library_versions: {
            const std::string own = "halflit " + std::string(version()) + " (pixel_epoch " + std::to_string(kPixelEpoch) + ")\n";
            return print(line->wanted == ParsedLine::Wanted::version ? own : own + HALFLIT_LIBRARY_VERSIONS "\n");
        }
        case ParsedLine::Wanted::self_test: {
            const SelfTest test = run_self_test(self_test_scenes());
            const int code = print(test.text);
            return code == 0 && !test.passed ? 1 : code;
        }
        case ParsedLine::Wanted::help:
        case ParsedLine::Wanted::help_all:
            break;
    }
    const bool all = line->wanted == ParsedLine::Wanted::help_all;
    return print(line->command == nullptr ? program_help(commands, all, help_width()) : command_help(*line->command, all, help_width()));
}

/// Memory for the end of a program that has no other: the first allocation that fails frees it and tries again.
std::atomic<void*> last_memory = nullptr;

void free_last_memory() {
    void* const kept = last_memory.exchange(nullptr);
    if (kept == nullptr) throw std::bad_alloc();
    std::free(kept);
}

}  // namespace

int main(int argc, char** argv) {
    last_memory = std::malloc(std::size_t{1} << 20);
    std::set_new_handler(free_last_memory);
    platform::prepare_streams();
    try {
        handle_signals();
        return parse_and_run(argc, argv);
    } catch (const std::bad_alloc&) {
        print_error("out of memory");
        return static_cast<int>(ErrorCode::limit);
    } catch (const std::exception& exception) {
        print_error(std::string("internal error: ") + exception.what());
        return static_cast<int>(ErrorCode::internal);
    }
}
