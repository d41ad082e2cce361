// Accessors: typed arrays inside buffers. All checks happen once, when the list is made; reading an element cannot fail after that.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace halflit::io::detail {

/// Component types by glTF's numbers.
enum class Component : std::uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

[[nodiscard]] std::size_t size_of(Component component);  ///< bytes

class Accessor {
public:
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] Component component() const { return component_; }
    [[nodiscard]] int components() const { return components_; }  ///< 1, 2, 3, 4, 9 or 16
    [[nodiscard]] bool normalized() const { return normalized_; }
    [[nodiscard]] const std::string& name() const { return name_; }  ///< "accessors[3]", for messages
    /// The same data, integers being normalised.
    [[nodiscard]] Accessor as_normalized() const {
        Accessor copy = *this;
        copy.normalized_ = true;
        return copy;
    }
    [[nodiscard]] std::size_t stride() const { return stride_; }  ///< bytes between elements; 0: no bufferView

    /// `out` takes components() values. Normalised integers become c/255, max(c/127, -1) and so on; others keep their value.
    void read_floats(std::size_t index, float* out) const;
    /// Reads one-component accessors and joints. `out` takes components() values of an unsigned component type.
    void read_unsigned(std::size_t index, std::uint32_t* out) const;

private:
    friend std::vector<Accessor> check_accessors(Document& document);
    friend const Accessor& usable(const std::vector<Accessor>& accessors, int index);
    void check(const Document& document, const file::Accessor& source);
    void read_source(Document& document, const file::Accessor& source);
    void warn_of_alignment(Document& document, const file::Accessor& source) const;
    void check_sparse(Document& document, const file::Sparse& source);
    [[nodiscard]] const std::byte* element(std::size_t index) const;  ///< null: zeros

    const std::byte* data_ = nullptr;
    std::size_t stride_ = 0, count_ = 0;
    Component component_ = Component::f32;
    bool normalized_ = false;
    int components_ = 1;
    std::vector<std::uint32_t> sparse_indices_;  // rising
    const std::byte* sparse_values_ = nullptr;   // packed
    std::string name_;
    std::string failure_;  // why it cannot be read
};

/// Every accessor of the file, checked against its view and buffer in 64-bit arithmetic. One that nothing drawn uses must not be read.
/// Throws LoadFailure for the others by the strict rules.
std::vector<Accessor> check_accessors(Document& document);

/// An accessor that can be read. Throws LoadFailure for one that is damaged or not there.
const Accessor& usable(const std::vector<Accessor>& accessors, int index);

}  // namespace halflit::io::detail
