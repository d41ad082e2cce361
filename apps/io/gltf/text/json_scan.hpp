// A strict pass over JSON text (RFC 8259), without recursion and without building a tree: a visitor gets the values. It stops at the first
// fault with its offset: nesting and token limits, UTF-8, duplicate keys, literals such as NaN, numbers outside double. A visitor may pass
// over those that other programs read.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace halflit::io::detail {

/// Thrown inside this folder only; read_gltf_json turns it into an Error with line, column and path.
struct JsonFault {
    ErrorCode code = ErrorCode::bad_input;
    std::size_t offset = 0;  ///< bytes from the start of the text
    std::string what;
};

enum class JsonType : std::uint8_t { object, array, string, integer, number, boolean, null };

[[nodiscard]] const char* name_of(JsonType type);

struct JsonValue {
    JsonType type = JsonType::null;
    std::size_t offset = 0;   ///< offset of the first byte; a string begins at its quote
    double number = 0;        ///< integer and number
    bool truth = false;       ///< boolean
    bool exact = true;        ///< false for an integer beyond 2^53, which not every reader keeps exactly
    std::string_view text{};  ///< string: decoded; valid during the call, or if `in_place` as long as the scanned text
    bool in_place = false;
};

/// Receives what the scan finds, in document order. Any call may throw JsonFault.
class JsonVisitor {
public:
    virtual ~JsonVisitor() = default;
    virtual void on_key(const JsonValue& key) = 0;  ///< a string
    virtual void on_begin(JsonType object_or_array, std::size_t offset) = 0;
    virtual void on_end(std::size_t end_offset) = 0;  ///< one past the closing bracket
    virtual void on_value(const JsonValue& value, std::size_t end_offset) = 0;
    /// A member whose key comes again in its object: `first` is the key's offset, `next` that of the member behind it. Called where the
    /// object ends. A fault, unless it is overridden.
    virtual void on_twin(std::string_view key, std::size_t first, std::size_t next, std::size_t again);
    /// A place that RFC 8259 forbids and that can be read: NaN, Infinity and what C prints for them (a number that is NaN or infinite), a
    /// number beyond double's range (infinite) or such as +1, .5, 1. or 01, True, False and None, a comma too many, a comment, a control
    /// character or half of a surrogate pair in a string, a backslash that is no escape sequence. Throws the fault, unless it is
    /// overridden: then it is read.
    virtual void on_loose(const JsonFault& fault) { throw fault; }
};

struct JsonScanLimits {
    int max_depth = 64;
    std::size_t max_tokens = 50'000'000;  ///< keys and values
};

/// Scans `text`. Throws JsonFault.
void scan_json(std::string_view text, const JsonScanLimits& limits, JsonVisitor& visitor);

}  // namespace halflit::io::detail
