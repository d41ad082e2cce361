// The instruction sets that kernels are built for, which of them this CPU can run, and the one in use.
#pragma once

#include "shading/result.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halflit::shading {

enum class Isa : std::uint8_t {
#define HALFLIT_SET(set, ...) set,
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET
};

/// "scalar", "sse2", "sse4.1", "avx2", "avx512", "neon64".
[[nodiscard]] std::string_view isa_name(Isa isa);

/// All names as "scalar, sse2, .. or neon64", for messages.
[[nodiscard]] std::string isa_names();

/// Instruction sets built into this binary, narrowest first.
[[nodiscard]] std::span<const Isa> built_isas();

/// True if this CPU and its operating system can run the set (by the compiler's CPU detection, which asks XGETBV too).
[[nodiscard]] bool isa_available(Isa isa);

/// The widest available set, or the one that the environment variable HALFLIT_KERNEL names. Fails if that name is unknown or the set is not
/// available.
[[nodiscard]] Result<Isa> default_isa();

/// "auto" gives default_isa(); an unknown or unavailable name is an error that lists the available ones.
[[nodiscard]] Result<Isa> isa_by_name(std::string_view name);

}  // namespace halflit::shading
