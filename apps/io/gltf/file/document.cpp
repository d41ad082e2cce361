#include "apps/io/gltf/file/document.hpp"

#include "apps/io/files/uri.hpp"
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

std::vector<std::byte> Document::read_uri(std::string_view uri, const std::string& where) {
    if (!is_data_uri(uri)) return take(read_named(take(decode_file_uri(uri, !options.strict), where)), where);
    bool loose = false;
    std::vector<std::byte> bytes = take(decode_data_uri(uri, options.limits.max_file_bytes, options.strict ? nullptr : &loose), where);
    if (loose) warn(fmt::format("{}: base64 with white space or percent sequences in it, which are read as browsers do", where));
    return bytes;
}

Result<std::vector<std::byte>> Document::read_named(std::string_view name, std::string* found) {
    const std::size_t most = options.limits.max_file_bytes;
    std::string read(name);
    auto bytes = options.strict ? folder.read(name, most) : folder.read_like(name, most, read);
    if (bytes) {
        named_bytes += bytes->size();
        grant_work(allowed_work() - detail::allowed_work(options.limits, file_bytes + named_bytes - bytes->size()));
    }
    if (bytes && found == nullptr && read != name)
        warn(fmt::format("\"{}\": there is no such file, \"{}\" is read", printable(name, 120), printable(read, 120)));
    if (found != nullptr) *found = std::move(read);
    return bytes;
}

std::vector<std::string> Document::take_warnings() {
    if (warnings_left_out > 0) warnings.push_back(fmt::format("and {} further warnings", warnings_left_out));
    return std::move(warnings);
}

void Document::go_on_without(const LoadFailure& failure, std::string_view instead) {
    if (options.strict || failure.error.code != ErrorCode::bad_input) throw failure;
    if (!first_failure) first_failure = failure.error;
    warn(fmt::format("{}; {}", failure.error.message, instead));
}

std::span<const std::byte> Document::view_data(int buffer_view) const {
    const file::BufferView& view = element(file.buffer_views, buffer_view, "bufferViews");
    const auto fault = [&](std::string_view what) { refuse(fmt::format("bufferViews[{}]", buffer_view), what); };
    if (view.damaged) fault("its compressed data are damaged");
    if (view.decoded >= 0) return element(decoded, view.decoded, "decoded bufferViews");
    const std::span<const std::byte> buffer = element(buffers, view.buffer, "buffers");
    const std::uint64_t end = view.byte_offset + view.byte_length;
    if (view.byte_offset > buffer.size() || (options.strict && end > buffer.size()))  // the buffer of a view that is not used is not there
        fault(fmt::format("ends at {} of buffer {}, of which {} bytes are there", end, view.buffer, buffer.size()));
    return buffer.subspan(static_cast<std::size_t>(view.byte_offset))
        .first(static_cast<std::size_t>(std::min<std::uint64_t>(view.byte_length, buffer.size() - view.byte_offset)));
}

}  // namespace halflit::io::detail
