// XML read by expat: elements in their order, with their attributes. XML's five entities are read, a file's own refuse it. What is wrong
// beside the elements, as a prefix that nothing declares or a byte that is not UTF-8, does not end the text.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace halflit::io::detail {

struct Document;

/// Name of an element; the namespace is empty where there is none, or the prefix is not declared.
struct XmlName {
    std::string_view space, local;
};

/// Attributes of an element, by their names as they are written.
class XmlAttributes {
public:
    explicit XmlAttributes(const char** list) : list_(list) {}
    /// A value by its name; null if it is not there.
    [[nodiscard]] const char* find(std::string_view name) const {
        for (const char** at = list_; *at != nullptr; at += 2)
            if (name == *at) return at[1];
        return nullptr;
    }
    /// The same by the name behind any prefix.
    [[nodiscard]] const char* find_prefixed(std::string_view local) const {
        for (const char** at = list_; *at != nullptr; at += 2) {
            const std::string_view name = *at;
            if (name.ends_with(local) && name.size() > local.size() && name[name.size() - local.size() - 1] == ':') return at[1];
        }
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
    /// line: where the element begins.
    virtual void begin(const XmlName& name, const XmlAttributes& attributes, std::size_t line) = 0;
    virtual void end(std::string_view local) = 0;
    /// A prefix of names, before the element that declares it begins.
    virtual void declare(std::string_view prefix, std::string_view name_space) {
        static_cast<void>(prefix);
        static_cast<void>(name_space);
    }
};

/// Reads a text, in which it replaces bytes that XML does not allow. `where` is for messages. Unless strict, a fault is warned of, and what
/// stands before it is read; text without any element is refused. Throws LoadFailure, and what the sink throws.
void read_xml(std::span<std::byte> text, const std::string& where, Document& document, XmlSink& sink);

}  // namespace halflit::io::detail
