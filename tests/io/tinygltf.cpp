// The one place where tinygltf's functions are compiled.
#include <fstream>  // tinygltf's writer needs it, and does not include it without its own file access

#define TINYGLTF_IMPLEMENTATION
#include "tests/io/tinygltf.hpp"
