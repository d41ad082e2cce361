// A glTF file between its bytes and the scene: the checked JSON, tinygltf's structures, the buffers, and what was said about it.
#pragma once

#include "apps/io/detail/gltf_precheck.hpp"
#include "apps/io/detail/tinygltf.hpp"
#include "apps/io/gltf_loader.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Thrown inside this folder only; load_gltf_bytes returns its Error.
struct LoadFailure {
    Error error;
};

/// Memory (or work) that a file may still cost.
class Budget {
public:
    Budget() = default;
    Budget(const char* what, std::uint64_t limit) : what_(what), limit_(limit) {}
    void take(std::uint64_t bytes);  ///< throws LoadFailure with ErrorCode::limit
    [[nodiscard]] std::uint64_t left() const { return limit_ - used_; }

private:
    const char* what_ = "";
    std::uint64_t limit_ = 0, used_ = 0;
};

struct Document {
    const LoadOptions& options;
    ModelFolder folder;
    Precheck json;
    tinygltf::Model model;
    std::vector<std::span<const std::byte>> buffers;  ///< byteLength bytes each
    std::vector<std::vector<std::byte>> owned_buffers;
    std::vector<std::string> warnings;
    std::size_t warnings_left_out = 0;
    SceneInfo info;
    Budget geometry, encoded_images;

    Document(const LoadOptions& load_options, const std::string& base_dir)
        : options(load_options), folder(base_dir, load_options.allow_external) {}

    /// Keeps the first hundred different ones.
    void warn(std::string what);
    [[nodiscard]] const std::byte* view_data(int buffer_view) const;  ///< after check_buffer_views
};

/// Throws LoadFailure "where: what".
[[noreturn]] void refuse(std::string_view where, std::string_view what, ErrorCode code = ErrorCode::bad_input);

/// Throws what `result` holds if it is an error, behind "where: ".
template <class T>
T take(Result<T>&& result, std::string_view where) {
    if (!result) refuse(where, result.error().message, result.error().code);
    return *std::move(result);
}

/// Parses, checks and fetches buffers; throws LoadFailure. `bytes` must outlive the document.
std::unique_ptr<Document> open_document(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options);

}  // namespace halflit::io::detail
