// The functions of the libraries that the build has.
#include "apps/io/codecs/codec_libraries.hpp"

#if defined(_WIN32)
#define HALFLIT_SHOWN
#else
#define HALFLIT_SHOWN __attribute__((visibility("default")))
#endif

extern "C" HALFLIT_SHOWN const halflit::io::detail::CodecLibraries* halflit_codec_libraries() {
    using namespace halflit::io::detail;
    static const CodecLibraries libraries = [] {
        CodecLibraries made;
#if HALFLIT_HAS_OPENEXR
        made.decode_exr = decode_exr_pixels;
        made.encode_exr = encode_exr_pixels;
#endif
#if HALFLIT_HAS_DRACO
        made.decode_draco = decode_draco_mesh;
#endif
        return made;
    }();
    return &libraries;
}
