#include "halflit/version.hpp"

#define HALFLIT_TEXT(x) #x
#define HALFLIT_VERSION_TEXT(major, minor, patch) HALFLIT_TEXT(major) "." HALFLIT_TEXT(minor) "." HALFLIT_TEXT(patch)

namespace halflit {

const char* version() { return HALFLIT_VERSION_TEXT(HALFLIT_VERSION_MAJOR, HALFLIT_VERSION_MINOR, HALFLIT_VERSION_PATCH); }

int pixel_epoch() { return kPixelEpoch; }

}  // namespace halflit
