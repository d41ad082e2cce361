#include "apps/engine/calls/answer_limits.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostNumbers = 16;      // of a list that stays whole: a matrix
constexpr std::size_t kMostTextBytes = 500;   // of a text in a report that is cut
constexpr std::size_t kMostLineBytes = 4000;  // of a line
constexpr const char* kCut = "...";

/// The text's beginning, whole characters of UTF-8.
std::string beginning_of(const std::string& text, std::size_t bytes) {
    if (text.size() <= bytes) return text;
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80) --bytes;
    return text.substr(0, bytes) + kCut;
}

/// A point, a matrix, or a row of one.
bool stays_whole(const Json& list) {
    return list.size() <= kMostNumbers &&
           std::all_of(list.begin(), list.end(), [](const Json& one) { return one.is_number() || (one.is_array() && stays_whole(one)); });
}

/// Copies a report without the items of its lists after the first `most`.
class ReportCutter {
public:
    explicit ReportCutter(std::size_t most) : most_(most) {}

    [[nodiscard]] Json cut(const Json& report) {
        Json kept = copy(report, Json::json_pointer());
        if (!left_out_.empty()) kept["left_out"] = std::move(left_out_);
        return kept;
    }

private:
    [[nodiscard]] Json copy(const Json& value, const Json::json_pointer& pointer) {
        if (value.is_string()) return beginning_of(value.get_ref<const std::string&>(), kMostTextBytes);
        if (value.is_object()) {
            Json object = Json::object();
            for (const auto& [key, one] : value.items()) object[key] = copy(one, pointer / key);
            return object;
        }
        if (!value.is_array() || stays_whole(value)) return value;
        Json list = Json::array();
        if (value.size() > most_) left_out_.push_back({{"list", pointer.to_string()}, {"items", value.size() - most_}});
        for (std::size_t i = 0; i < std::min(value.size(), most_); ++i) list.push_back(copy(value[i], pointer / i));
        return list;
    }

    std::size_t most_;
    Json left_out_ = Json::array();
};

}  // namespace

Json bounded_report(Json report, std::size_t most_bytes) {
    Json kept = std::move(report);
    if (to_text(kept, true).size() <= most_bytes) return kept;
    const Json whole = std::move(kept);
    for (const std::size_t most : {10000, 5000, 2000, 1000, 500, 200, 100, 50, 20, 10, 5, 2, 1}) {
        kept = ReportCutter(most).cut(whole);
        if (to_text(kept, true).size() <= most_bytes) return kept;
    }
    // Lists of one item are too much: the largest members go.
    while (to_text(kept, true).size() > most_bytes) {
        std::string largest;
        std::size_t bytes = 0;
        for (const auto& [key, one] : kept.items())
            if (const std::size_t size = to_text(one, true).size(); key != "left_out" && size > bytes) largest = key, bytes = size;
        if (bytes == 0) break;
        const Json& member = kept[largest];
        kept["left_out"].push_back(
            {{"list", (Json::json_pointer() / largest).to_string()}, {"items", member.is_structured() ? member.size() : 1}});
        kept.erase(largest);
    }
    return kept;
}

std::string bounded_lines(std::string lines, std::size_t most_bytes) {
    if (lines.size() <= most_bytes) return lines;
    std::string kept;
    std::size_t begin = 0;
    while (begin < lines.size()) {
        const std::size_t end = std::min(lines.find('\n', begin), lines.size());
        const std::string line = beginning_of(lines.substr(begin, end - begin), kMostLineBytes) + "\n";
        if (kept.size() + line.size() > most_bytes) break;
        kept += line;
        begin = std::min(end + 1, lines.size());
    }
    const auto left = std::count(lines.begin() + static_cast<std::ptrdiff_t>(begin), lines.end(), '\n') + (lines.ends_with('\n') ? 0 : 1);
    return begin < lines.size() ? fmt::format("{}({} more lines are left out)\n", kept, left) : kept;
}

}  // namespace halflit::engine
