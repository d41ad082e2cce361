// XML read by expat: elements in their order, with their attributes. No document type declaration is accepted, so there are no entities.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace halflit::io::detail {

/// Attributes of an element: "namespace local" or "local" names, and their values.
class XmlAttributes {
public:
    explicit XmlAttributes(const char** list) : list_(list) {}
    /// A value by its name; null if it is not there.
    [[nodiscard]] const char* find(std::string_view name) const {
        for (const char** at = list_; *at != nullptr; at += 2)
            if (name == *at) return at[1];
        return nullptr;
    }
    [[nodiscard]] std::string_view get(std::string_view name) const {
        const char* value = find(name);
        return value == nullptr ? std::string_view() : std::string_view(value);
    }

private:
    const char** list_;
};

/// Receives the elements. It may throw.
class XmlSink {
public:
    virtual ~XmlSink() = default;
    /// name: "namespace local". line: where the element begins.
    virtual void begin(std::string_view name, const XmlAttributes& attributes, std::size_t line) = 0;
    virtual void end(std::string_view name) = 0;
    /// A prefix of names, before the element that declares it begins.
    virtual void declare(std::string_view prefix, std::string_view name_space) {
        static_cast<void>(prefix);
        static_cast<void>(name_space);
    }
};

/// Reads a text. `where` is for messages. Throws LoadFailure, and what the sink throws.
void read_xml(std::span<const std::byte> text, const std::string& where, XmlSink& sink);

}  // namespace halflit::io::detail
