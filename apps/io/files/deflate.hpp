// Data that deflate has packed.
#pragma once

#include <libdeflate.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

namespace halflit::io::detail {

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};
using Decompressor = std::unique_ptr<libdeflate_decompressor, FreeDecompressor>;

/// Throws std::bad_alloc.
[[nodiscard]] inline Decompressor make_decompressor() {
    Decompressor made(libdeflate_alloc_decompressor());
    if (!made) throw std::bad_alloc();
    return made;
}

/// Unpacks a zlib stream that fills `to`. False: it is damaged, or of another length.
[[nodiscard]] inline bool unpack_zlib(std::span<const std::byte> from, std::span<std::uint8_t> to) {
    return libdeflate_zlib_decompress(make_decompressor().get(), from.data(), from.size(), to.data(), to.size(), nullptr) ==
           LIBDEFLATE_SUCCESS;
}

}  // namespace halflit::io::detail
