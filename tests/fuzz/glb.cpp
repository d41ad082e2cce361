// Bytes as a .glb file.
#include "tests/fuzz/loading.hpp"
#include "tests/fuzz/mutate.hpp"

namespace halflit::fuzz {
namespace {

void run(View input) {
    const bool strict = input.size() % 8 == 0;  // both, as GLB files are padded to 4 bytes
    const auto loaded = load_gltf_bytes(as_bytes(input), "fuzz.glb", "", small_limits(strict));
    if (loaded)
        check_loaded(*loaded);
    else
        check_error(loaded.error());
}

}  // namespace

const FuzzTarget kGlb{"glb", 32768, run, mutate_glb};

}  // namespace halflit::fuzz
