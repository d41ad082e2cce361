// Makes a libFuzzer program of the target that HALFLIT_FUZZ_TARGET names.
#include "tests/fuzz/target.hpp"

#include <algorithm>

using namespace halflit::fuzz;

namespace {

constexpr const FuzzTarget& kTarget = HALFLIT_FUZZ_TARGET;

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): libFuzzer's names
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size <= kTarget.max_bytes) kTarget.run({data, size});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
    max_size = std::min(max_size, kTarget.max_bytes);
    Random random(seed);
    Bytes bytes(data, data + std::min(size, max_size));
    if (kTarget.mutate == nullptr || random.one_in(16))
        mutate_bytes(bytes, max_size);
    else
        kTarget.mutate(bytes, max_size, random);
    if (bytes.size() > max_size) bytes.resize(max_size);
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}
// NOLINTEND(readability-identifier-naming)
