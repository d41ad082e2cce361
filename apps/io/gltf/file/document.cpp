#include "apps/io/gltf/file/document.hpp"

#include "apps/io/gltf/file/indices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace halflit::io::detail {

void Document::warn(std::string what) {
    constexpr std::size_t kMost = 100;
    if (std::find(warnings.begin(), warnings.end(), what) != warnings.end()) return;
    if (warnings.size() < kMost)
        warnings.push_back(std::move(what));
    else
        ++warnings_left_out;
}

Result<std::vector<std::byte>> Document::read_named(std::string_view name) {
    const std::size_t most = options.limits.max_file_bytes;
    if (options.strict) return folder.read(name, most);
    std::string found;
    auto bytes = folder.read_like(name, most, found);
    if (bytes && found != name)
        warn(fmt::format("\"{}\": there is no such file, \"{}\" is read", printable(name, 120), printable(found, 120)));
    return bytes;
}

std::vector<std::string> Document::take_warnings() {
    if (warnings_left_out > 0) warnings.push_back(fmt::format("and {} further warnings", warnings_left_out));
    return std::move(warnings);
}

const std::byte* Document::view_data(int buffer_view) const {
    const file::BufferView& view = element(file.buffer_views, buffer_view, "bufferViews");
    if (view.decoded >= 0) return element(decoded, view.decoded, "decoded bufferViews").data();
    const std::span<const std::byte> buffer = element(buffers, view.buffer, "buffers");
    if (view.byte_offset + view.byte_length > buffer.size())  // the buffer of a view that is not used is not there
        refuse(fmt::format("bufferViews[{}]", buffer_view), fmt::format("ends at {} of buffer {}, of which {} bytes are there",
                                                                        view.byte_offset + view.byte_length, view.buffer, buffer.size()));
    return buffer.data() + view.byte_offset;
}

}  // namespace halflit::io::detail
