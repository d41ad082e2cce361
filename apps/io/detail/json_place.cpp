#include "apps/io/detail/json_place.hpp"

#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace halflit::io::detail {

namespace {

/// Follows the scan up to a given offset and gives the path there.
class PathFinder final : public JsonVisitor {
public:
    explicit PathFinder(std::size_t offset) : wanted_(offset) {}
    void on_key(const JsonValue& key) override {
        if (key.offset > wanted_) throw JsonFault{};
        levels_.back().key = key.text;
        if (key.offset == wanted_) throw JsonFault{};
    }
    void on_begin(JsonType type, std::size_t offset) override {
        enter(offset);
        levels_.push_back({type == JsonType::object, 0, {}});
    }
    void on_end(std::size_t) override { levels_.pop_back(); }
    void on_value(const JsonValue& value, std::size_t) override { enter(value.offset); }

    [[nodiscard]] std::string path() const {
        std::string out;
        for (const Level& level : levels_) {
            if (level.object && !level.key.empty()) out += fmt::format("{}{}", out.empty() ? "" : ".", printable(level.key, 60));
            if (!level.object && level.count > 0) out += fmt::format("[{}]", level.count - 1);
        }
        return out;
    }

private:
    struct Level {
        bool object;
        std::size_t count;
        std::string key;
    };
    void enter(std::size_t offset) {
        if (offset > wanted_) throw JsonFault{};
        if (!levels_.empty()) ++levels_.back().count;
        if (offset == wanted_) throw JsonFault{};
    }
    std::size_t wanted_;
    std::vector<Level> levels_;
};

}  // namespace

TextPlace place_of(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const std::size_t line_start = before.rfind('\n');
    return {1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')),
            1 + before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1)};
}

std::string json_path_at(std::string_view text, std::size_t offset, const JsonScanLimits& limits) {
    PathFinder finder(offset);
    try {
        scan_json(text, limits, finder);
    } catch (const JsonFault&) {  // the fault itself, or the offset was reached
    }
    return finder.path();
}

}  // namespace halflit::io::detail
