#include "apps/io/models/xml_reader.hpp"

#include "apps/io/files/load_failure.hpp"

#include "apps/io/files/text.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <expat.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <type_traits>

namespace halflit::io::detail {

namespace {

constexpr int kMostDepth = 64;

std::uint64_t line_of(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
    return XML_GetCurrentLineNumber64(parser);
#else
    return XML_GetCurrentLineNumber(parser);
#endif
}

struct Reading {
    XML_Parser parser;
    XmlSink& sink;
    std::exception_ptr failure;  ///< expat is C: exceptions do not pass through it
    int depth = 0;

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
};

void XMLCALL begin(void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded([&] {
        const std::size_t line = line_of(reading.parser);
        if (++reading.depth > kMostDepth)
            refuse(fmt::format("line {}", line), fmt::format("more than {} elements inside each other", kMostDepth), ErrorCode::limit);
        reading.sink.begin(name, XmlAttributes(attributes), line);
    });
}

void XMLCALL end(void* user, const XML_Char* name) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded([&] {
        --reading.depth;
        reading.sink.end(name);
    });
}

void XMLCALL declare(void* user, const XML_Char* prefix, const XML_Char* name_space) {
    auto& reading = *static_cast<Reading*>(user);
    const auto text = [](const XML_Char* given) { return given == nullptr ? std::string_view() : std::string_view(given); };
    reading.guarded([&] { reading.sink.declare(text(prefix), text(name_space)); });
}

void XMLCALL doctype(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    auto& reading = *static_cast<Reading*>(user);
    reading.guarded(
        [&] { refuse(fmt::format("line {}", line_of(reading.parser)), "has a document type declaration, which 3MF does not allow"); });
}

}  // namespace

void read_xml(std::span<const std::byte> text, const std::string& where, XmlSink& sink) {
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(XML_ParserCreateNS(nullptr, ' '),
                                                                                               &XML_ParserFree);
    if (!parser) refuse(where, "out of memory", ErrorCode::limit);
    Reading reading{parser.get(), sink, nullptr};
    XML_SetUserData(parser.get(), &reading);
    XML_SetElementHandler(parser.get(), begin, end);
    XML_SetStartNamespaceDeclHandler(parser.get(), declare);
    XML_SetStartDoctypeDeclHandler(parser.get(), doctype);
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    for (std::size_t at = 0;;) {
        check_time();
        const std::size_t size = std::min(kChunk, text.size() - at);
        const bool is_last = at + size == text.size();
        const XML_Status status =
            XML_Parse(parser.get(), reinterpret_cast<const char*>(text.data()) + at, static_cast<int>(size), is_last ? 1 : 0);
        if (reading.failure) std::rethrow_exception(reading.failure);
        if (status != XML_STATUS_OK) {
            const XML_Error error = XML_GetErrorCode(parser.get());
            refuse(fmt::format("{}: line {}", where, line_of(parser.get())), printable(XML_ErrorString(error)),
                   error == XML_ERROR_NO_MEMORY ? ErrorCode::limit : ErrorCode::bad_input);
        }
        at += size;
        if (is_last) return;
    }
}

}  // namespace halflit::io::detail
