#include "apps/io/codecs/codec_libraries.hpp"

// A program with the module defines this function itself, so that its linker takes neither this file nor the libraries.
halflit::Result<const halflit::io::detail::CodecLibraries*> halflit::io::detail::codec_libraries() { return halflit_codec_libraries(); }
