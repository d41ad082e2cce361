#include "halflit/isa.hpp"

#include "shading/kernels/isa_select.hpp"

#include <cstdlib>
#include <string>

// A module that loads these kernels apart defines it.
#ifndef HALFLIT_HAS_WASM128
#define HALFLIT_HAS_WASM128 true
#endif

namespace halflit {
namespace {

#define HALFLIT_LIST(set, ...) Isa::set,
constexpr Isa kBuiltIsas[] = {HALFLIT_FOR_BUILT_ISAS(HALFLIT_LIST, 0)};

// The public enumeration has its names written out, so that its header needs no other file. They must be those of the list, in its order.
enum class Listed : std::uint8_t {
#define HALFLIT_SET(set, ...) set,
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET
};
#define HALFLIT_SET(set, ...) static_assert(static_cast<int>(Isa::set) == static_cast<int>(Listed::set));
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET

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
#define HALFLIT_SET(set, name, ...) \
    case Isa::set:                  \
        return name;
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET
    }
    return "unknown";
}

std::string isa_names() {
    std::string names;
#define HALFLIT_SET(set, name, ...) names += (names.empty() ? "" : ", ") + std::string(name);
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET
    return names.replace(names.rfind(", "), 2, " or ");
}

std::span<const Isa> built_isas() { return kBuiltIsas; }

bool isa_available(Isa isa) {
    if (!built(isa)) return false;
#if defined(__x86_64__)
    __builtin_cpu_init();
#define HALFLIT_CPU_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#else
#define HALFLIT_CPU_HAS(feature) false
#endif
    switch (isa) {
#define HALFLIT_SET(set, name, arch, processor, flags, condition, has) \
    case Isa::set:                                                     \
        return has;
#include "shading/kernels/isa_list.def"
#undef HALFLIT_SET
    }
    return false;
}

Result<Isa> default_isa() {
    // The only place where the library reads an environment variable.
    if (const char* name = std::getenv("HALFLIT_KERNEL"); name != nullptr && *name != '\0' && std::string_view(name) != "auto")
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

}  // namespace halflit
