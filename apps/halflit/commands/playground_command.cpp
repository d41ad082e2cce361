// halflit playground: the browser page (apps/web), which the build gives as a file and the program carries.
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/flags/message_flags.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"

#include <memory>
#include <span>
#include <string>

#if HALFLIT_HAS_PLAYGROUND
asm(".section .rodata\n"
    "halflit_playground_begin:\n"
    ".incbin \"" HALFLIT_PLAYGROUND_PAGE
    "\"\n"
    "halflit_playground_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" {
__attribute__((visibility("hidden"))) extern const std::uint8_t halflit_playground_begin[];
__attribute__((visibility("hidden"))) extern const std::uint8_t halflit_playground_end[];
}
#endif

namespace halflit::cli {
namespace {

Result<int> run_playground(const std::string& output) {
#if HALFLIT_HAS_PLAYGROUND
    const std::span<const std::uint8_t> page(halflit_playground_begin, halflit_playground_end);
    if (const auto written = io::write_file(output, page); !written) return tl::unexpected(written.error());
    if (output != "-") print_note("wrote " + output);
    return 0;
#else
    (void)output;
    return fail(ErrorCode::io,
                "playground: this program was built without the page; './dev web' makes it, and the CMake option HALFLIT_PLAYGROUND_PAGE "
                "gives it to the program");
#endif
}

}  // namespace

Command playground_command() {
    const auto output = std::make_shared<std::string>("playground.html");
    return {"playground",
            "Write a page in which a browser draws models, with sliders for lobes, lights, shadows and sky; it needs no server",
            {},
            {{"Flags", {{"-o,--output", "FILE", "The page, one file (default playground.html); -: standard output", read_text(*output)}}},
             {"Messages", message_flags()}},
            [output] { return run_playground(*output); },
            Command::Listed::by_help_all,
            {},
            {},
            HALFLIT_HAS_PLAYGROUND == 0};
}

}  // namespace halflit::cli
