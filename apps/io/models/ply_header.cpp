#include "apps/io/models/ply_header.hpp"

#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kMostElements = 64, kMostProperties = 256;

std::optional<PlyType> type_named(std::string_view name) {
    using enum PlyType;
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{{"char", i8},
                                                                           {"int8", i8},
                                                                           {"uchar", u8},
                                                                           {"uint8", u8},
                                                                           {"short", i16},
                                                                           {"int16", i16},
                                                                           {"ushort", u16},
                                                                           {"uint16", u16},
                                                                           {"int", i32},
                                                                           {"int32", i32},
                                                                           {"uint", u32},
                                                                           {"uint32", u32},
                                                                           {"float", f32},
                                                                           {"float32", f32},
                                                                           {"double", f64},
                                                                           {"float64", f64}}};
    for (const auto& [known, type] : kNames)
        if (known == name) return type;
    return std::nullopt;
}

PlyType read_type(std::string_view name, const std::string& where) {
    const auto type = type_named(name);
    if (!type) refuse(where, fmt::format("expected a type such as float or uchar, found \"{}\"", printable(name, 40)));
    return *type;
}

PlyProperty read_property(Words& words, const std::string& where) {
    PlyProperty property;
    std::string_view word = words.next();
    if (word == "list") {
        property.is_list = true;
        property.count_type = read_type(words.next(), where);
        if (property.count_type >= PlyType::f32) refuse(where, "expected a whole number as the type of a list's length");
        word = words.next();
    }
    property.type = read_type(word, where);
    property.name = words.next();
    if (property.name.empty()) refuse(where, "expected the property's name");
    return property;
}

PlyFormat read_format(std::string_view word, const std::string& where) {
    if (word == "ascii") return PlyFormat::ascii;
    if (word == "binary_little_endian") return PlyFormat::little_endian;
    if (word != "binary_big_endian")
        refuse(where, fmt::format("expected ascii, binary_little_endian or binary_big_endian, found \"{}\"", printable(word, 40)));
    return PlyFormat::big_endian;
}

}  // namespace

PlyHeader read_ply_header(std::span<const std::byte> bytes, bool strict) {
    PlyHeader header;
    Lines lines({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::string_view line;
    bool has_format = false;
    lines.next(line);  // "ply"
    for (;;) {
        if (!lines.next(line)) refuse("", "the file ends before \"end_header\"");
        const std::string where = fmt::format("line {}", lines.number());
        Words words(line);
        const std::string_view word = words.next();
        if (word == "end_header") break;
        if (word == "format") {
            header.format = read_format(words.next(), where);
            has_format = true;
        } else if (word == "element") {
            const std::string_view name = words.next();
            const auto count = parse_whole<std::uint64_t>(words.next());
            if (!count) refuse(where, "expected the element's name and its number");
            if (header.elements.size() >= kMostElements) refuse(where, fmt::format("more than {} elements", kMostElements));
            header.elements.push_back({name, *count, {}});
        } else if (word == "property") {
            if (header.elements.empty()) refuse(where, "a property comes before any element");
            auto& properties = header.elements.back().properties;
            if (properties.size() >= kMostProperties) refuse(where, fmt::format("more than {} properties", kMostProperties));
            properties.push_back(read_property(words, where));
        } else if (word == "comment") {
            if (same_word(words.next(), "texturefile") && header.textures.size() < kMostProperties) header.textures.push_back(words.rest());
        } else if (word != "obj_info" && !word.empty()) {
            if (strict) refuse(where, fmt::format("expected element, property or end_header, found \"{}\"", printable(word, 40)));
            if (header.unknown.size() < kMostElements)
                header.unknown.push_back(fmt::format("{}: \"{}\" is not known", where, printable(word, 40)));
        }
    }
    if (!has_format) refuse("", "the header has no format");
    header.body = std::as_bytes(std::span(lines.left()));
    header.lines = lines.number();
    return header;
}

}  // namespace halflit::io::detail
