#include "apps/io/models/xml_reader.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/file/document.hpp"
#include "apps/io/models/model_text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <expat.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace halflit::io::detail {

namespace {

constexpr int kMostDepth = 64;
constexpr std::uint64_t kUnitsAnElement = 500;  ///< of charge_work

std::uint64_t line_of(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
    return XML_GetCurrentLineNumber64(parser);
#else
    return XML_GetCurrentLineNumber(parser);
#endif
}

/// True for the text behind '&' if it is one of XML's five entities, or the number of a character that XML has.
bool is_reference(std::string_view text) {
    text = text.substr(0, std::min<std::size_t>(text.find(';'), 12));
    for (const std::string_view name : {"amp", "lt", "gt", "quot", "apos"})
        if (text == name) return true;
    if (!text.starts_with('#')) return false;
    const bool is_hex = text.starts_with("#x");
    const std::string_view digits = text.substr(is_hex ? 2 : 1);
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, is_hex ? 16 : 10);
    return error == std::errc() && end == digits.data() + digits.size() && code < 0x110000 &&
           (code >= 0x20 || code == '\t' || code == '\n' || code == '\r') && (code < 0xD800 || code > 0xDFFF) && (code | 1u) != 0xFFFF;
}

/// Puts '?' and the like in place of what ends a parser: bytes that are not UTF-8, control characters, '&' and '<' that begin nothing, and
/// "--" in comments. Returns how many it replaced.
std::size_t mend(std::span<std::byte> bytes, bool is_utf8) {
    constexpr std::pair<std::string_view, std::string_view> kFree[] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::size_t mended = 0, free_to = 0, comment = text.size();  // up to free_to, '&' and '<' are text; comment: where one begins
    const auto replace = [&](std::size_t at, char by) { bytes[at] = static_cast<std::byte>(by), ++mended; };
    TimeCheck check;
    for (std::size_t at = 0; at < text.size(); ++at) {
        check();
        const auto c = static_cast<unsigned char>(text[at]);
        const char next = at + 1 < text.size() ? text[at + 1] : ' ';
        if (c >= 0x80 && is_utf8) {
            const int length = utf8_sequence(text, at);
            if (length == 0)
                replace(at, '?');
            else
                at += static_cast<std::size_t>(length) - 1;
        } else if (c < 0x20 && c != '\t' && c != '\n' && c != '\r') {
            replace(at, ' ');
        } else if (at < free_to) {
            if (c == '-' && next == '-' && at >= comment) replace(at, '+');
        } else if (c == '&' && !is_reference(text.substr(at + 1, 12))) {
            replace(at, '+');
        } else if (c == '<' && (next == '!' || next == '?')) {
            for (const auto& [begin, end] : kFree) {
                if (!text.substr(at).starts_with(begin)) continue;
                free_to = std::min(text.find(end, at + begin.size()), text.size());
                comment = begin == "<!--" ? at + begin.size() : text.size();
            }
        } else if (c == '<' && static_cast<unsigned char>(next) < 'A' && next != '/' && next != ':') {
            replace(at, '(');
        }
    }
    return mended;
}

/// The encoding to read a text by, whatever it says of itself: null: by its first bytes (UTF-16).
const char* encoding_of(std::string_view text) {
    const std::string_view first = text.substr(0, 4);
    if (first.starts_with("\xFE\xFF") || first.starts_with("\xFF\xFE") || first.find('\0') != std::string_view::npos) return nullptr;
    const std::string_view head = text.substr(0, std::min<std::size_t>(text.find("?>"), 200));
    const std::size_t at = head.find("encoding=");
    const std::string_view named = at == std::string_view::npos ? head.substr(0, 0) : head.substr(std::min(at + 10, head.size()));
    for (const std::string_view begin : {"iso-8859", "windows-12", "latin"})
        if (same_word(named.substr(0, begin.size()), begin)) return "ISO-8859-1";
    return "UTF-8";
}

struct Reading {
    XML_Parser parser;
    XmlSink& sink;
    const std::string& where;
    Document& document;
    std::exception_ptr failure;  ///< expat is C: exceptions do not pass through it
    int depth = 0;
    std::uint64_t elements = 0;
    bool has_lost_prefix = false;
    std::map<std::string, std::vector<std::string>, std::less<>> spaces;  ///< of a prefix, the innermost last
    std::vector<std::pair<int, decltype(spaces)::iterator>> declared;     ///< with the depth of its element

    template <class Action>
    void guarded(const Action& action) {
        if (failure) return;
        try {
            action();
        } catch (...) {
            failure = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }
    [[nodiscard]] LoadFailure fault(const std::string& what) const {
        return {{ErrorCode::bad_input, fmt::format("{}: line {}: {}", where, line_of(parser), what)}};
    }
    void declare(const char** attributes) {
        for (; *attributes != nullptr; attributes += 2) {
            std::string_view name = *attributes;
            if (!name.starts_with("xmlns") || (name.size() > 5 && name[5] != ':')) continue;
            name.remove_prefix(std::min<std::size_t>(name.size(), 6));
            const std::string_view space = attributes[1];
            document.geometry.take(name.size() + space.size() + 128);
            const auto entry = spaces.try_emplace(std::string(name)).first;
            entry->second.emplace_back(space);
            declared.emplace_back(depth, entry);
            sink.declare(name, space);
        }
    }
    /// The prefix of a name becomes its namespace.
    XmlName resolve(std::string_view name) {
        const std::size_t colon = name.find(':');
        const std::string_view prefix = colon == std::string_view::npos ? std::string_view() : name.substr(0, colon);
        const std::string_view local = name.substr(prefix.empty() ? 0 : colon + 1);
        const auto found = spaces.find(prefix);
        if (found != spaces.end() && !found->second.empty()) return {found->second.back(), local};
        if (!prefix.empty() && !std::exchange(has_lost_prefix, true))
            document.go_on_without(fault(fmt::format("the prefix \"{}\" is not declared", printable(prefix, 40))),
                                   "its elements are left out");
        return {"", local};
    }
};

void XMLCALL begin(void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded([&] {
        charge_work(kUnitsAnElement);
        if (++reading.elements % 1024 == 0) check_time();
        const std::size_t line = line_of(reading.parser);
        if (++reading.depth > kMostDepth)
            refuse(fmt::format("line {}", line), fmt::format("more than {} elements inside each other", kMostDepth), ErrorCode::limit);
        reading.declare(attributes);
        reading.sink.begin(reading.resolve(name), XmlAttributes(attributes), line);
    });
}

void XMLCALL end(void* user, const XML_Char* name) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded([&] {
        const std::string_view whole = name;
        reading.sink.end(whole.substr(whole.find(':') + 1));
        for (; !reading.declared.empty() && reading.declared.back().first == reading.depth; reading.declared.pop_back())
            reading.declared.back().second->second.pop_back();
        --reading.depth;
    });
}

void XMLCALL doctype(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int has_entities) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded([&] {
        const LoadFailure found = reading.fault("has a document type declaration, which 3MF does not allow");
        if (has_entities != 0) throw found;
        reading.document.go_on_without(found, "it is left out");
    });
}

}  // namespace

void read_xml(std::span<std::byte> text, const std::string& where, Document& document, XmlSink& sink) {
    const auto chars = [&] { return std::string_view(reinterpret_cast<const char*>(text.data()), text.size()); };
    text = text.subspan(text.size() - as_text(text).size());
    while (!text.empty() && (is_blank(chars()[0]) || is_line_end(chars()[0]))) text = text.subspan(1);
    const char* const encoding = encoding_of(chars());
    // The declaration is not needed then, nor may it be wrong.
    const std::size_t declared = encoding != nullptr && chars().starts_with("<?xml ") ? chars().find("?>") : std::string_view::npos;
    if (declared != std::string_view::npos) text = text.subspan(declared + 2);
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(XML_ParserCreate(encoding), &XML_ParserFree);
    if (!parser) refuse(where, "out of memory", ErrorCode::limit);
    Reading reading{parser.get(), sink, where, document, nullptr, 0, 0, false, {}, {}};
    if (const std::size_t mended = encoding == nullptr ? 0 : mend(text, std::string_view(encoding) == "UTF-8"); mended > 0)
        document.go_on_without({{ErrorCode::bad_input, fmt::format("{}: has {} characters that XML does not allow there", where, mended)}},
                               "others are put in their place");
    XML_SetUserData(parser.get(), &reading);
    XML_SetElementHandler(parser.get(), begin, end);
    XML_SetStartDoctypeDeclHandler(parser.get(), doctype);
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    for (std::size_t at = 0;;) {
        check_time();
        const std::size_t size = std::min(kChunk, text.size() - at);
        charge_work(size);
        const bool is_last = at + size == text.size();
        const XML_Status status =
            XML_Parse(parser.get(), reinterpret_cast<const char*>(text.data()) + at, static_cast<int>(size), is_last ? 1 : 0);
        if (reading.failure) std::rethrow_exception(reading.failure);
        if (status != XML_STATUS_OK) {
            const XML_Error error = XML_GetErrorCode(parser.get());
            if (error == XML_ERROR_NO_MEMORY) refuse(where, "out of memory", ErrorCode::limit);
            const LoadFailure found = reading.fault(printable(XML_ErrorString(error)));
            if (reading.elements == 0) throw found;
            document.go_on_without(found, "what stands before it is read");
            return;
        }
        at += size;
        if (is_last) return;
    }
}

}  // namespace halflit::io::detail
