#include "shading/kernels/isa.hpp"
#include "shading/kernels/isa_select.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include <cstdlib>
#include <string>

namespace halflit::shading {

// Defined in shade_<isa>.cpp.
extern const ShadeKernels shade_kernels_scalar, shade_kernels_sse2, shade_kernels_sse41, shade_kernels_avx2, shade_kernels_avx512,
    shade_kernels_neon64;

namespace {

constexpr Isa kBuiltIsas[] = {
    Isa::scalar,
#ifdef HALFLIT_HAVE_SSE2
    Isa::sse2,
#endif
#ifdef HALFLIT_HAVE_SSE41
    Isa::sse41,
#endif
#ifdef HALFLIT_HAVE_AVX2
    Isa::avx2,
#endif
#ifdef HALFLIT_HAVE_AVX512
    Isa::avx512,
#endif
#ifdef HALFLIT_HAVE_NEON64
    Isa::neon64,
#endif
};

bool built(Isa isa) {
    for (const Isa b : kBuiltIsas)
        if (b == isa) return true;
    return false;
}

Result<Isa> named_isa(std::string_view name, const std::string& source) {
    for (const Isa isa : kBuiltIsas)
        if (isa_name(isa) == name && isa_available(isa)) return isa;
    std::string known;
    for (const Isa isa : kBuiltIsas)
        if (isa_available(isa)) known += (known.empty() ? "" : ", ") + std::string(isa_name(isa));
    return fail(ErrorCode::usage,
                source + ": '" + std::string(name) + "' is not an instruction set that this program can run here, expected auto, " + known);
}

}  // namespace

std::string_view isa_name(Isa isa) {
    switch (isa) {
        case Isa::scalar:
            return "scalar";
        case Isa::sse2:
            return "sse2";
        case Isa::sse41:
            return "sse4.1";
        case Isa::avx2:
            return "avx2";
        case Isa::avx512:
            return "avx512";
        case Isa::neon64:
            return "neon64";
    }
    return "unknown";
}

std::span<const Isa> built_isas() { return kBuiltIsas; }

bool isa_available(Isa isa) {
    if (!built(isa)) return false;
#if defined(__x86_64__)
    __builtin_cpu_init();
    switch (isa) {
        case Isa::sse41:
            return __builtin_cpu_supports("sse4.1") != 0;
        case Isa::avx2:
            return __builtin_cpu_supports("avx2") != 0;
        case Isa::avx512:
            return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx2") != 0;
        default:
            return true;
    }
#else
    return true;
#endif
}

Result<Isa> default_isa() {
    // Read here and nowhere else: the one way for the environment to reach the library.
    if (const char* name = std::getenv("HALFLIT_KERNEL"); name != nullptr && std::string_view(name) != "auto")
        return named_isa(name, "HALFLIT_KERNEL");
    Isa widest = Isa::scalar;
    for (const Isa isa : kBuiltIsas)
        if (isa_available(isa)) widest = isa;
    return widest;
}

Result<Isa> isa_by_name(std::string_view name) {
    if (name == "auto") return default_isa();
    return named_isa(name, "isa");
}

const ShadeKernels& shade_kernels(Isa isa) {
    HALFLIT_ASSERT(isa_available(isa));
    HALFLIT_RETURN_TABLE_OF(isa, shade_kernels)
}

}  // namespace halflit::shading
