// The instruction sets that kernels are built for, which of them this CPU can run, and the one in use. All give the same pixels.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace halflit {

/// Narrowest first.
enum class Isa : std::uint8_t { scalar, sse2, sse41, avx2, avx512, neon64, wasm128 };

/// "scalar", "sse2", "sse4.1", "avx2", "avx512", "neon64", "wasm128".
[[nodiscard]] HALFLIT_API std::string_view isa_name(Isa isa);

/// All names as "scalar, sse2, .. or wasm128", for messages.
[[nodiscard]] HALFLIT_API std::string isa_names();

/// Instruction sets built into this library, narrowest first.
[[nodiscard]] HALFLIT_API std::span<const Isa> built_isas();

/// True if this CPU and its operating system can run the set (by the compiler's CPU detection, which asks XGETBV too).
[[nodiscard]] HALFLIT_API bool isa_available(Isa isa);

/// The widest available set, or the one that the environment variable HALFLIT_KERNEL names. Fails if that name is unknown or the set is not
/// available.
[[nodiscard]] HALFLIT_API Result<Isa> default_isa();

/// "auto" gives default_isa(); an unknown or unavailable name is an error that lists the available ones.
[[nodiscard]] HALFLIT_API Result<Isa> isa_by_name(std::string_view name);

}  // namespace halflit
