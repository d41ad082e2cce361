// What is done to the JSON text before tinygltf builds its model: scan, check against the schema, and take out what tinygltf must not
// act upon (buffers and images, so that it never opens a file nor decodes anything).
#pragma once

#include "apps/io/detail/gltf_schema.hpp"
#include "apps/io/detail/json_scan.hpp"
#include "shading/result.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

struct BufferEntry {
    std::string_view uri;  ///< into the scanned text or Precheck::texts
    bool has_uri = false;
    std::uint64_t byte_length = 0;
};

struct ImageEntry {
    std::string_view uri;
    bool has_uri = false;
    int buffer_view = -1;
};

struct Precheck {
    std::string_view json;     ///< the text, without byte order mark and padding
    std::string for_tinygltf;  ///< the same length, with dropped values overwritten
    std::array<std::size_t, kTargetCount> counts{};
    std::size_t animations = 0, primitives = 0;
    std::vector<BufferEntry> buffers;
    std::vector<ImageEntry> images;
    std::vector<std::string> extensions_used, extensions_required;
    std::vector<std::string> warnings;
    std::deque<std::string> texts;

    [[nodiscard]] std::size_t count(Target target) const { return counts[static_cast<std::size_t>(target)]; }
    [[nodiscard]] bool uses(std::string_view extension) const;
};

/// `text` must outlive the result. Faults name line, column and path; the message has no file prefix.
/// `max_model_bytes`: memory that the tree may take, estimated from what the scan counts.
Result<Precheck> precheck_gltf(std::string_view text, const JsonScanLimits& limits, std::uint64_t max_model_bytes);

}  // namespace halflit::io::detail
