// codec_libraries() of a program with the module.
#include "apps/io/codecs/codec_libraries.hpp"

#include <fmt/format.h>

#include <dlfcn.h>

#include <mutex>
#include <string>
#include <string_view>

namespace halflit::io::detail {

namespace {

/// $ORIGIN is the program's folder. It is not among the folders in which the system looks for all libraries of the program (RUNPATH), as
/// looking there takes .7 ms.
Result<const CodecLibraries*> open_module() {
    std::string reason;
    for (const char* name : {"$ORIGIN/halflit_codecs.so", "$ORIGIN/" HALFLIT_CODEC_FOLDER "/halflit_codecs.so"}) {
        void* const module = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (module == nullptr) {
            const char* const told = ::dlerror();
            if (reason.empty() ||
                (told != nullptr && std::string_view(told).find("halflit_codecs.so: cannot open") == std::string_view::npos))
                reason = told != nullptr ? told : "";
            continue;
        }
        const auto shown = reinterpret_cast<decltype(&halflit_codec_libraries)>(::dlsym(module, "halflit_codec_libraries"));
        const CodecLibraries* const libraries = shown == nullptr ? nullptr : shown();
        if (libraries != nullptr && std::string_view(libraries->version) == HALFLIT_CODEC_VERSION) return libraries;
        reason = "it is of another build than the program";
    }
    return fail(ErrorCode::io, fmt::format("EXR files and Draco meshes need halflit_codecs.so: {}", reason));
}

}  // namespace

Result<const CodecLibraries*> codec_libraries() {
    static std::mutex mutex;
    static const CodecLibraries* libraries = nullptr;
    const std::lock_guard lock(mutex);
    if (libraries != nullptr) return libraries;
    auto opened = open_module();  // a failure may pass
    if (opened) libraries = *opened;
    return opened;
}

}  // namespace halflit::io::detail
