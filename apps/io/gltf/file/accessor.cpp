#include "apps/io/gltf/file/accessor.hpp"

#include "apps/io/gltf/file/indices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace halflit::io::detail {

namespace {

static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

template <class T>
T load(const std::byte* at) {
    T value;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&value, at, sizeof value);
    } else {
        std::byte swapped[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i) swapped[i] = at[sizeof(T) - 1 - i];
        std::memcpy(&value, swapped, sizeof value);
    }
    return value;
}

Component component_of(int type, std::string_view where) {
    switch (type) {
        case 5120:
            return Component::i8;
        case 5121:
            return Component::u8;
        case 5122:
            return Component::i16;
        case 5123:
            return Component::u16;
        case 5125:
            return Component::u32;
        case 5126:
            return Component::f32;
        default:
            refuse(fmt::format("{}.componentType", where), fmt::format("expected 5120 to 5123, 5125 or 5126, found {}", type));
    }
}

/// Refuses unless `count` elements of `size` bytes, `stride` apart, from `offset` on, lie within a view. All arguments are at most
/// 2^53, stride at most 252: the sum stays below 2^62.
void check_range(std::string_view where, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, std::uint64_t size,
                 std::uint64_t view_bytes) {
    if (count == 0) return;
    const std::uint64_t end = offset + stride * (count - 1) + size;
    if (end > view_bytes)
        refuse(where, fmt::format("{} elements of {} bytes, {} apart from byte {} on, end at {}, but the bufferView has {} bytes", count,
                                  size, stride, offset, end, view_bytes));
}

float to_float(const std::byte* at, Component component, bool normalized) {
    switch (component) {
        case Component::f32:
            return load<float>(at);
        case Component::u8: {
            const float value = static_cast<float>(load<std::uint8_t>(at));
            return normalized ? value / 255.0f : value;
        }
        case Component::i8: {
            const float value = static_cast<float>(load<std::int8_t>(at));
            return normalized ? std::max(value / 127.0f, -1.0f) : value;
        }
        case Component::u16: {
            const float value = static_cast<float>(load<std::uint16_t>(at));
            return normalized ? value / 65535.0f : value;
        }
        case Component::i16: {
            const float value = static_cast<float>(load<std::int16_t>(at));
            return normalized ? std::max(value / 32767.0f, -1.0f) : value;
        }
        case Component::u32:
            break;
    }
    return static_cast<float>(load<std::uint32_t>(at));
}

std::uint32_t to_unsigned(const std::byte* at, Component component) {
    switch (component) {
        case Component::u8:
            return load<std::uint8_t>(at);
        case Component::u16:
            return load<std::uint16_t>(at);
        default:
            return load<std::uint32_t>(at);
    }
}

}  // namespace

std::size_t size_of(Component component) {
    switch (component) {
        case Component::i8:
        case Component::u8:
            return 1;
        case Component::i16:
        case Component::u16:
            return 2;
        default:
            return 4;
    }
}

const std::byte* Accessor::element(std::size_t index) const {
    if (!sparse_indices_.empty()) {
        const auto found = std::lower_bound(sparse_indices_.begin(), sparse_indices_.end(), index);
        if (found != sparse_indices_.end() && *found == index)
            return sparse_values_ +
                   static_cast<std::size_t>(found - sparse_indices_.begin()) * size_of(component_) * static_cast<std::size_t>(components_);
    }
    return data_ == nullptr ? nullptr : data_ + index * stride_;
}

void Accessor::read_floats(std::size_t index, float* out) const {
    const std::byte* at = element(index);
    for (int c = 0; c < components_; ++c)
        out[c] = at == nullptr ? 0.0f : to_float(at + static_cast<std::size_t>(c) * size_of(component_), component_, normalized_);
}

void Accessor::read_unsigned(std::size_t index, std::uint32_t* out) const {
    const std::byte* at = element(index);
    for (int c = 0; c < components_; ++c)
        out[c] = at == nullptr ? 0u : to_unsigned(at + static_cast<std::size_t>(c) * size_of(component_), component_);
}

void Accessor::check(const Document& document, const file::Accessor& source) {
    component_ = component_of(source.component_type, name_);
    components_ = source.components;
    normalized_ = source.normalized;
    count_ = static_cast<std::size_t>(source.count);
    if (count_ != source.count) refuse(name_, fmt::format("{} elements are more than memory can hold", source.count), ErrorCode::limit);
    const std::uint64_t size = size_of(component_) * static_cast<std::uint64_t>(components_);
    if (source.buffer_view == kBadIndex) refuse(name_, "its bufferView is not there");
    if (source.buffer_view < 0) return;  // all zeros, apart from sparse values
    const file::BufferView& view = document.file.buffer_views[static_cast<std::size_t>(source.buffer_view)];
    stride_ = static_cast<std::size_t>(view.byte_stride == 0 ? size : static_cast<std::uint64_t>(view.byte_stride));
    if (stride_ < size)
        refuse(name_, fmt::format("bufferViews[{}].byteStride is {}, expected at least the element's {} bytes", source.buffer_view, stride_,
                                  size));
    if (document.options.strict || !document.used.has(Target::buffer_views, static_cast<std::size_t>(source.buffer_view)))
        check_range(name_, source.byte_offset, count_, stride_, size, view.byte_length);
}

/// Takes the data, all of which must be there by the strict rules.
void Accessor::read_source(Document& document, const file::Accessor& source) {
    check(document, source);
    warn_of_alignment(document, source);
    if (source.buffer_view >= 0 && count_ > 0) {
        const std::span<const std::byte> bytes = document.view_data(source.buffer_view);
        const std::uint64_t size = size_of(component_) * static_cast<std::uint64_t>(components_);
        const std::uint64_t most = source.byte_offset + size <= bytes.size() ? (bytes.size() - source.byte_offset - size) / stride_ + 1 : 0;
        if (most < count_) {
            const LoadFailure failure{
                {ErrorCode::bad_input, fmt::format("{}: has {} elements, but the data hold {}", name_, count_, most)}};
            if (most == 0) throw failure;
            document.go_on_without(failure, "these are read");
            count_ = static_cast<std::size_t>(most);
        }
        data_ = bytes.data() + source.byte_offset;
    }
    if (source.sparse >= 0) check_sparse(document, document.file.sparse[static_cast<std::size_t>(source.sparse)]);
}

void Accessor::warn_of_alignment(Document& document, const file::Accessor& source) const {
    if (source.normalized && (component_ == Component::f32 || component_ == Component::u32))
        document.warn(fmt::format("{}.normalized: componentType {} is never normalized, read as it is", name_, source.component_type));
    if (source.buffer_view < 0) return;
    const auto multiple = static_cast<std::uint64_t>(size_of(component_));
    const file::BufferView& view = document.file.buffer_views[static_cast<std::size_t>(source.buffer_view)];
    if (source.byte_offset % multiple != 0)
        document.warn(
            fmt::format("{}.byteOffset: expected a multiple of {}, found {}, read as it is", name_, multiple, source.byte_offset));
    if (view.byte_offset % multiple != 0)
        document.warn(fmt::format("bufferViews[{}].byteOffset: expected a multiple of {} for {}, found {}, read as it is",
                                  source.buffer_view, multiple, name_, view.byte_offset));
}

void Accessor::check_sparse(Document& document, const file::Sparse& source) {
    const std::string where = name_ + ".sparse";
    const auto sparse_count = static_cast<std::uint64_t>(source.count);
    if (sparse_count == 0) return;
    if (sparse_count > count_) refuse(where + ".count", fmt::format("is {}, more than the accessor's {}", sparse_count, count_));
    if (count_ > 0xFFFFFFFFull)
        refuse(where, fmt::format("the accessor has {} elements, the limit is 4294967295", count_), ErrorCode::limit);
    const Component index_type = component_of(source.index_component_type, where + ".indices");
    if (index_type != Component::u8 && index_type != Component::u16 && index_type != Component::u32)
        refuse(where + ".indices.componentType", fmt::format("expected 5121, 5123 or 5125, found {}", source.index_component_type));

    const auto& views = document.file.buffer_views;
    detail::element(views, source.index_view, "bufferViews");
    detail::element(views, source.value_view, "bufferViews");
    const std::uint64_t size = size_of(component_) * static_cast<std::uint64_t>(components_), index_size = size_of(index_type);
    const auto index_offset = static_cast<std::uint64_t>(source.index_offset),
               value_offset = static_cast<std::uint64_t>(source.value_offset);
    const auto unaligned = [&](const char* which, std::uint64_t offset, std::uint64_t multiple) {
        if (offset % multiple != 0)
            document.warn(
                fmt::format("{}.{}.byteOffset: expected a multiple of {}, found {}, read as it is", where, which, multiple, offset));
    };
    unaligned("indices", index_offset, index_size);
    unaligned("values", value_offset, size_of(component_));
    for (const int view : {source.index_view, source.value_view})
        if (views[static_cast<std::size_t>(view)].byte_stride != 0)
            document.warn(fmt::format("bufferViews[{}].byteStride: {} is packed, the stride is ignored", view, where));
    const std::span<const std::byte> index_data = document.view_data(source.index_view), value_data = document.view_data(source.value_view);
    check_range(where + ".indices", index_offset, sparse_count, index_size, index_size, index_data.size());
    check_range(where + ".values", value_offset, sparse_count, size, size, value_data.size());

    document.geometry.take(sparse_count * sizeof(std::uint32_t));
    sparse_indices_.reserve(static_cast<std::size_t>(sparse_count));
    const std::byte* indices = index_data.data() + index_offset;
    for (std::uint64_t i = 0; i < sparse_count; ++i) {
        const std::uint32_t index = to_unsigned(indices + i * index_size, index_type);
        if (index >= count_) refuse(where + ".indices", fmt::format("entry {} is {}, but the accessor has {} elements", i, index, count_));
        if (i > 0 && index <= sparse_indices_.back())
            refuse(where + ".indices", fmt::format("entry {} is {}, expected more than {} before it", i, index, sparse_indices_.back()));
        sparse_indices_.push_back(index);
    }
    sparse_values_ = value_data.data() + value_offset;
}

std::vector<Accessor> check_accessors(Document& document) {
    std::vector<Accessor> accessors(document.file.accessors.size());
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const file::Accessor& source = document.file.accessors[i];
        const bool used = document.used.has(Target::accessors, i);
        if (!used && document.warnings_are_full()) continue;
        Accessor& accessor = accessors[i];
        accessor.name_ = fmt::format("accessors[{}]", source.stands_for >= 0 ? static_cast<std::size_t>(source.stands_for) : i);
        if (!used) {
            if (source.component_type == 0) continue;  // that the type is not there has been noted
            try {
                accessor.check(document, source);
            } catch (const LoadFailure& failure) {
                document.warn(fmt::format("{}; {}", failure.error.message, kNothingUsesIt));
            }
            continue;
        }
        const auto is_read = [&](int view) { return document.used.has(Target::buffer_views, static_cast<std::size_t>(view)); };
        // Else a decoded accessor stands in its place.
        if (source.buffer_view >= 0 && !is_read(source.buffer_view)) continue;
        if (source.sparse >= 0) {
            const file::Sparse& sparse = document.file.sparse[static_cast<std::size_t>(source.sparse)];
            if (!is_read(sparse.index_view) || !is_read(sparse.value_view)) continue;
        }
        try {
            accessor.read_source(document, source);
        } catch (const LoadFailure& failure) {
            if (document.options.strict || failure.error.code != ErrorCode::bad_input) throw;
            Accessor damaged;  // what uses it is left out, with a warning
            damaged.name_ = accessor.name_;
            damaged.failure_ = failure.error.message;
            accessor = std::move(damaged);
        }
    }
    return accessors;
}

const Accessor& usable(const std::vector<Accessor>& accessors, int index) {
    const Accessor& accessor = element(accessors, index, "accessors");
    if (!accessor.failure_.empty()) throw LoadFailure{{ErrorCode::bad_input, accessor.failure_}};
    return accessor;
}

}  // namespace halflit::io::detail
