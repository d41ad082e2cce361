// tinygltf, as this folder uses it: the JSON text becomes typed structures, and nothing else. Its file access, image decoding and Draco
// are not compiled in. Its namespace gets another name, so that a program which links its own tinygltf meets no second definition.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf halflit_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

namespace halflit::io::detail {
namespace tinygltf = ::halflit_tinygltf;
}
