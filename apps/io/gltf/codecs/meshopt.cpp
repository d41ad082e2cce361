#include "apps/io/gltf/codecs/meshopt.hpp"
#include "apps/io/files/optional_libraries.hpp"

#include "apps/io/gltf/codecs/meshopt_filter.hpp"
#include "apps/io/gltf/codecs/meshopt_vertices.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#if HALFLIT_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

bool halflit::io::has_meshopt() { return HALFLIT_HAS_MESHOPT != 0; }

namespace halflit::io::detail {

namespace {

using file::CompressedView, file::CompressionMode;

bool is_decoded(const Document& document, std::size_t view) {
    return document.used.has(Target::buffer_views, view) && document.file.buffer_views[view].compressed >= 0;
}

#if HALFLIT_HAS_MESHOPT

/// Least size of data that decode to `size` bytes.
std::uint64_t least_bytes(const CompressedView& view, std::uint64_t size) {
    switch (view.mode) {
        case CompressionMode::attributes:
            // Version 1 spends at least two bits on 256 bytes, version 0 sixteen times as many.
            return size / 1024 + 1;
        case CompressionMode::triangles:
            return view.count / 3 + 17;
        case CompressionMode::indices:
            break;
    }
    return view.count + 5;
}

/// Checks all that the JSON tells. Returns the decoded size.
std::uint64_t check(const Document& document, const file::BufferView& parent, const CompressedView& view, const std::string& where) {
    const auto stride = static_cast<std::uint64_t>(view.byte_stride);
    const bool indices = view.mode != CompressionMode::attributes;
    if (indices ? stride != 2 && stride != 4 : stride == 0 || stride % 4 != 0 || stride > 256)
        refuse(where + ".byteStride",
               fmt::format("expected {}, found {}", indices ? "2 or 4 for indices" : "a multiple of 4 from 4 to 256", stride));
    if (view.mode == CompressionMode::triangles && view.count % 3 != 0)
        refuse(where + ".count", fmt::format("expected a multiple of 3, found {}", view.count));
    if (indices && view.filter != file::CompressionFilter::none) refuse(where + ".filter", "expected NONE for indices");
    if (!fits(view.filter, stride)) refuse(where + ".filter", fmt::format("does not fit elements of {} bytes", stride));
    if (parent.byte_stride != 0 && parent.byte_stride != view.byte_stride)
        refuse(where + ".byteStride", fmt::format("is {}, but that of the bufferView is {}", stride, parent.byte_stride));
    const std::uint64_t size = stride * view.count;  // at most 2^61
    if (size != parent.byte_length)
        refuse(where, fmt::format("{} elements of {} bytes are {} bytes, but the bufferView has {}", view.count, stride, size,
                                  parent.byte_length));
    const std::uint64_t end = view.byte_offset + view.byte_length, there = element(document.buffers, view.buffer, "buffers").size();
    if (end > there)
        refuse(where, fmt::format("byteOffset {} and byteLength {} end at {}, but buffer {} has {} bytes", view.byte_offset,
                                  view.byte_length, end, view.buffer, there));
    if (view.byte_length < least_bytes(view, size))
        refuse(where, fmt::format("{} bytes cannot hold {} elements of {} bytes", view.byte_length, view.count, stride));
    return size;
}

bool decode(const CompressedView& view, std::span<const std::byte> from, std::span<std::byte> to) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
    const auto stride = static_cast<std::size_t>(view.byte_stride);
    switch (view.mode) {
        case CompressionMode::attributes:
            if (from.front() == kVertexCodec1) return decode_vertices_1(from, to, stride);
            return meshopt_decodeVertexBuffer(to.data(), view.count, stride, bytes, from.size()) == 0;
        case CompressionMode::triangles:
            if (meshopt_decodeIndexBuffer(to.data(), view.count, stride, bytes, from.size()) != 0) return false;
            break;
        case CompressionMode::indices:
            if (meshopt_decodeIndexSequence(to.data(), view.count, stride, bytes, from.size()) != 0) return false;
            break;
    }
    if constexpr (std::endian::native == std::endian::big)  // the library writes integers, and glTF's are little-endian
        for (std::size_t at = 0; at < to.size(); at += stride) std::reverse(to.data() + at, to.data() + at + stride);
    return true;
}

std::vector<std::byte> decode_view(Document& document, std::size_t index) {
    const file::BufferView& parent = document.file.buffer_views[index];
    const CompressedView& view = document.file.compressed_views[static_cast<std::size_t>(parent.compressed)];
    const std::string where = fmt::format("bufferViews[{}].extensions.meshopt_compression", index);
    check_time();
    const std::uint64_t size = check(document, parent, view, where);
    document.geometry.take(size);
    std::vector<std::byte> out(size);
    if (size == 0) return out;
    const auto from = document.buffers[static_cast<std::size_t>(view.buffer)].subspan(view.byte_offset, view.byte_length);
    if (!decode(view, from, out)) refuse(where, "the compressed data are damaged");
    apply_filter(view.filter, out, static_cast<std::size_t>(view.byte_stride));
    return out;
}

#endif

}  // namespace

std::uint64_t compressed_bytes(const Document& document) {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < document.file.buffer_views.size(); ++i)
        if (is_decoded(document, i))
            bytes += document.file.compressed_views[static_cast<std::size_t>(document.file.buffer_views[i].compressed)].byte_length;
    return bytes;
}

void decode_views([[maybe_unused]] Document& document) {
#if HALFLIT_HAS_MESHOPT
    for (std::size_t i = 0; i < document.file.buffer_views.size(); ++i) {
        if (!is_decoded(document, i)) continue;
        try {
            document.decoded.push_back(decode_view(document, i));
        } catch (const LoadFailure& failure) {
            document.go_on_without(failure, "what is in it is left out");
            document.file.buffer_views[i].damaged = true;
            continue;
        }
        document.file.buffer_views[i].decoded = static_cast<int>(document.decoded.size() - 1);
    }
#endif
}

}  // namespace halflit::io::detail
