// Bytes as a .gltf file. No other file is read: buffers and pictures are data URIs.
#include "tests/fuzz/loading.hpp"
#include "tests/fuzz/mutate.hpp"

namespace halflit::fuzz {
namespace {

void run(View input) {
    for (const bool strict : {true, false}) {
        const auto loaded = load_gltf_bytes(as_bytes(input), "fuzz.gltf", "", small_limits(strict));
        if (loaded)
            check_loaded(*loaded);
        else
            check_error(loaded.error());
        if (loaded && strict) return;  // what is not strict draws more, never less
    }
}

}  // namespace

const FuzzTarget kGltfText{"gltf_text", 32768, run, mutate_gltf_json};

}  // namespace halflit::fuzz
