// codec_libraries() of a program with the module.
#include "apps/io/codecs/codec_libraries.hpp"

#include <dlfcn.h>

namespace halflit::io::detail {

namespace {

/// Null: not found. $ORIGIN is the program's folder. It is not among the folders in which the system looks for all libraries of the
/// program (RUNPATH), as looking there takes .7 ms.
const CodecLibraries* open_module() {
    void* module = nullptr;
    for (const char* name : {"$ORIGIN/halflit_codecs.so", "$ORIGIN/" HALFLIT_CODEC_FOLDER "/halflit_codecs.so"})
        if (module == nullptr) module = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) return nullptr;
    const auto libraries = reinterpret_cast<decltype(&halflit_codec_libraries)>(::dlsym(module, "halflit_codec_libraries"));
    return libraries == nullptr ? nullptr : libraries();
}

}  // namespace

Result<const CodecLibraries*> codec_libraries() {
    static const CodecLibraries* const libraries = open_module();
    if (libraries == nullptr)
        return fail(ErrorCode::io, "EXR files and Draco meshes need halflit_codecs.so, which is not beside the program");
    return libraries;
}

}  // namespace halflit::io::detail
