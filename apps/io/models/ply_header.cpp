#include "apps/io/models/ply_header.hpp"

#include "apps/io/files/load_failure.hpp"
#include "apps/io/models/text_scanner.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kMostElements = 64, kMostProperties = 256;

std::optional<PlyType> type_named(std::string_view name) {
    using enum PlyType;
    static constexpr std::pair<std::string_view, PlyType> kNames[] = {
        {"char", i8},    {"int8", i8},   {"uchar", u8},    {"uint8", u8},   {"bool", u8},    {"byte", i8},
        {"ubyte", u8},   {"short", i16}, {"int16", i16},   {"ushort", u16}, {"uint16", u16}, {"int", i32},
        {"int32", i32},  {"uint", u32},  {"uint32", u32},  {"long", i64},   {"int64", i64},  {"ulong", u64},
        {"uint64", u64}, {"float", f32}, {"float32", f32}, {"double", f64}, {"float64", f64}};
    for (const auto& [known, type] : kNames)
        if (same_word(name, known)) return type;
    return std::nullopt;
}

/// A text may name any type: its numbers are read as they are written.
PlyType read_type(std::string_view name, const TextScanner& scanner, PlyFormat format) {
    const auto type = type_named(name);
    if (!type && (format != PlyFormat::ascii || name.empty())) scanner.refuse_word(name, "a type such as float or uchar");
    return type.value_or(PlyType::f64);
}

PlyProperty read_property(TextScanner& scanner, PlyFormat format) {
    PlyProperty property;
    std::string_view word = scanner.word_in_line();
    if (same_word(word, "list")) {
        property.is_list = true;
        word = scanner.word_in_line();
        property.count_type = read_type(word, scanner, format);
        if (!is_whole(property.count_type)) scanner.refuse_word(word, "a whole number as the type of a list's length");
        word = scanner.word_in_line();
    }
    property.type = read_type(word, scanner, format);
    property.name = scanner.word_in_line();
    if (property.name.empty()) scanner.refuse_word("", "the property's name");
    return property;
}

PlyFormat read_format(std::string_view word, const TextScanner& scanner) {
    if (same_word(word, "ascii")) return PlyFormat::ascii;
    if (same_word(word, "binary_little_endian")) return PlyFormat::little_endian;
    if (!same_word(word, "binary_big_endian")) scanner.refuse_word(word, "ascii, binary_little_endian or binary_big_endian");
    return PlyFormat::big_endian;
}

}  // namespace

PlyHeader read_ply_header(std::span<const std::byte> bytes, Document& document) {
    PlyHeader header;
    TextScanner scanner(as_text(bytes), document);
    bool has_format = false;
    scanner.word();  // "ply"
    for (;;) {
        scanner.skip_line();
        const std::string_view word = scanner.word();
        if (word.empty()) refuse("", "the file ends before \"end_header\"");
        if (same_word(word, "end_header") || (same_word(word, "end") && same_word(scanner.next_in_line(), "header"))) break;
        if (same_word(word, "format")) {
            header.format = read_format(scanner.word_in_line(), scanner);
            has_format = true;
        } else if (same_word(word, "element")) {
            const std::string_view name = scanner.word_in_line(), number = scanner.word_in_line();
            const auto count = TextScanner::parse_count(number);
            if (!count) scanner.refuse_word(number, "the element's name and its number");
            if (header.elements.size() >= kMostElements) refuse(scanner.where(), fmt::format("more than {} elements", kMostElements));
            header.elements.push_back({name, *count, {}});
        } else if (same_word(word, "property")) {
            if (header.elements.empty()) refuse(scanner.where(), "a property comes before any element");
            auto& properties = header.elements.back().properties;
            if (properties.size() >= kMostProperties) refuse(scanner.where(), fmt::format("more than {} properties", kMostProperties));
            properties.push_back(read_property(scanner, header.format));
        } else if (same_word(word, "comment")) {
            const std::string_view key = scanner.word_in_line();
            if (same_word(key, "texturefile") && header.textures.size() < kMostProperties)
                header.textures.push_back(scanner.rest_of_line(true));
            if (same_word(key, "splatrendermode:")) header.trained_as = scanner.word_in_line();
            if (same_word(key, "antialiased")) header.trained_as = scanner.word_in_line() == "1" ? "antialiased" : "";
        } else if (!same_word(word, "obj_info")) {
            scanner.unknown(word, "element, property or end_header");
        }
    }
    scanner.skip_line();
    scanner.warn();
    header.lines = scanner.line();
    header.body = scanner.left();
    header.body.remove_prefix(header.body.starts_with("\r\n") ? 2 : header.body.empty() ? 0 : 1);
    if (const LoadFailure failure{{ErrorCode::bad_input, "the header has no format"}}; !has_format) {
        if (!begins_as_text(std::as_bytes(std::span(header.body.data(), header.body.size())))) throw failure;
        document.go_on_without(failure, "read as text");
    }
    return header;
}

}  // namespace halflit::io::detail
