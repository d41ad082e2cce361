#include "apps/io/pictures/exr_header.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace halflit::io::detail {
namespace {

constexpr std::uint32_t kDeep = 0x800, kMultiPart = 0x1000;
constexpr std::size_t kLongestName = 255;
/// Most lines that a compression packs into one block, DWAB's.
constexpr long long kBlockLines = 256;
/// Most memory for the blocks or tiles that the library holds at a time, bytes.
constexpr long long kMostBlockBytes = 1LL << 28;  // the clock is looked at between blocks

tl::unexpected<Error> refuse(std::string message) { return fail(ErrorCode::bad_input, std::move(message)); }

class Bytes {
public:
    explicit Bytes(std::span<const std::byte> file, std::size_t at) : file_(file), at_(at) {}

    /// A text that ends with a zero byte; false where it is longer than names may be, or the file ends.
    bool text(std::string_view& out) {
        const auto rest = file_.subspan(at_);
        const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
        const auto length = static_cast<std::size_t>(end - rest.begin());
        if (end == rest.end() || length > kLongestName) return false;
        out = {reinterpret_cast<const char*>(rest.data()), length};
        at_ += length + 1;
        return true;
    }
    bool int32(std::int32_t& out) {
        if (file_.size() - at_ < 4) return false;
        out = int32_at(file_, at_);
        at_ += 4;
        return true;
    }
    bool take(std::size_t count, std::span<const std::byte>& out) {
        if (file_.size() - at_ < count) return false;
        out = file_.subspan(at_, count);
        at_ += count;
        return true;
    }
    static std::int32_t int32_at(std::span<const std::byte> bytes, std::size_t at) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i) bits |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
        return static_cast<std::int32_t>(bits);
    }

private:
    std::span<const std::byte> file_;
    std::size_t at_;
};

/// A list of channels: a name, then 16 bytes, for each; a zero byte ends it.
bool count_channels(std::span<const std::byte> list, std::size_t& count) {
    Bytes bytes(list, 0);
    std::string_view name;
    std::span<const std::byte> rest;
    for (count = 0; bytes.text(name); ++count) {
        if (name.empty()) return true;
        if (!bytes.take(16, rest)) return false;
    }
    return false;
}

Result<void> read_attribute(std::string_view name, std::span<const std::byte> value, ExrHeader& header) {
    const auto broken = [&] { return refuse(fmt::format("header: the attribute {} is broken", name)); };
    if (name == "dataWindow") {
        if (value.size() != 16) return broken();
        header.width = 1LL + Bytes::int32_at(value, 8) - Bytes::int32_at(value, 0);
        header.height = 1LL + Bytes::int32_at(value, 12) - Bytes::int32_at(value, 4);
        if (header.width < 1 || header.height < 1) return broken();
    } else if (name == "tiles") {
        if (value.size() != 9) return broken();
        header.tile_width = Bytes::int32_at(value, 0);
        header.tile_height = Bytes::int32_at(value, 4);
        if (header.tile_width < 1 || header.tile_height < 1) return broken();
    } else if (name == "channels") {
        if (!count_channels(value, header.channels) || header.channels == 0) return broken();
    } else if (name == "envmap" && value.size() == 1 && value[0] == std::byte{1}) {
        return refuse("header: expected a picture of latitude and longitude, found a cube map");
    }
    return {};
}

}  // namespace

Result<ExrHeader> read_exr_header(std::span<const std::byte> file, const FloatImageLimits& limits) {
    if (file.size() < 8) return refuse("the file ends within the header");
    const auto version = static_cast<std::uint32_t>(Bytes::int32_at(file, 4));
    if ((version & 0xff) != 2) return refuse(fmt::format("expected an EXR file of version 2, found {}", version & 0xff));
    if ((version & kDeep) != 0) return refuse("expected a flat picture, found deep data");
    if ((version & kMultiPart) != 0) return refuse("expected one picture, found a file of several parts");
    ExrHeader header;
    Bytes bytes(file, 8);
    for (;;) {
        std::string_view name, type;
        std::int32_t size = 0;
        std::span<const std::byte> value;
        if (!bytes.text(name)) return refuse("the file ends within the header, or a name in it is too long");
        if (name.empty()) break;
        if (!bytes.text(type) || !bytes.int32(size) || size < 0 || !bytes.take(static_cast<std::size_t>(size), value))
            return refuse(fmt::format("the file ends within the header, at \"{}\"", printable(name, 40)));
        if (auto ok = read_attribute(name, value, header); !ok) return tl::unexpected(ok.error());
    }
    if (header.width == 0 || header.channels == 0) return refuse("header: expected the attributes channels and dataWindow");
    if (auto ok = check_float_image_size(header.width, header.height, limits); !ok) return tl::unexpected(ok.error());
    const long long lines = header.tile_height > 0 ? header.tile_height : kBlockLines;
    const long long columns = std::max(header.width, header.tile_width);
    if (lines > kMostBlockBytes || columns > kMostBlockBytes ||
        static_cast<long long>(header.channels) > kMostBlockBytes / (4 * columns) / lines)
        return fail(ErrorCode::limit, fmt::format("{} channels in blocks of {}x{} pixels, the limit is {} bytes a block", header.channels,
                                                  columns, lines, kMostBlockBytes));
    return header;
}

}  // namespace halflit::io::detail
