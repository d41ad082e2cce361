#include "apps/io/gltf/text/json_place.hpp"

#include "apps/io/files/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace halflit::io::detail {

namespace {

/// Follows the scan past given offsets, which rise, and gives the paths there.
class PathFinder final : public JsonVisitor {
public:
    explicit PathFinder(std::span<const std::size_t> offsets) : wanted_(offsets) {}
    void on_key(const JsonValue& key) override {
        pass(key.offset);
        levels_.back().key = key.text;
        reach(key.offset);
    }
    void on_begin(JsonType type, std::size_t offset) override {
        enter(offset);
        levels_.push_back({type == JsonType::object, 0, {}});
    }
    void on_end(std::size_t) override { levels_.pop_back(); }
    void on_value(const JsonValue& value, std::size_t) override { enter(value.offset); }
    void on_loose(const JsonFault& fault) override { reach(fault.offset); }

    /// One path for each offset: those behind the end of the scan have the path of the end.
    [[nodiscard]] std::vector<std::string> paths() const {
        std::vector<std::string> out = found_;
        out.resize(wanted_.size(), path());
        return out;
    }

private:
    struct Level {
        bool object;
        std::size_t count;
        std::string key;
    };
    [[nodiscard]] std::string path() const {
        std::string out;
        for (const Level& level : levels_) {
            if (level.object && !level.key.empty()) out += fmt::format("{}{}", out.empty() ? "" : ".", printable(level.key, 60));
            if (!level.object && level.count > 0) out += fmt::format("[{}]", level.count - 1);
        }
        return out;
    }
    void enter(std::size_t offset) {
        pass(offset);
        if (!levels_.empty()) ++levels_.back().count;
        reach(offset);
    }
    /// Offsets before `offset` lie between two values: they have the path of the one before.
    void pass(std::size_t offset) {
        while (found_.size() < wanted_.size() && wanted_[found_.size()] < offset) found_.push_back(path());
        if (found_.size() == wanted_.size()) throw JsonFault{};
    }
    void reach(std::size_t offset) { pass(offset + 1); }

    std::span<const std::size_t> wanted_;
    std::vector<std::string> found_;
    std::vector<Level> levels_;
};

}  // namespace

TextPlace place_of(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const std::size_t line_start = before.rfind('\n');
    return {1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')),
            1 + before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1)};
}

std::vector<std::string> json_paths_at(std::string_view text, std::span<const std::size_t> offsets, const JsonScanLimits& limits) {
    PathFinder finder(offsets);
    if (offsets.empty()) return {};
    try {
        scan_json(text, limits, finder);
    } catch (const JsonFault&) {  // the fault itself, or the last offset was reached
    }
    return finder.paths();
}

std::string named_place(std::string_view text, std::size_t offset) {
    const TextPlace place = place_of(text, offset);
    return fmt::format("line {}, column {}", place.line, place.column);
}

std::string json_path_at(std::string_view text, std::size_t offset, const JsonScanLimits& limits) {
    return json_paths_at(text, {&offset, 1}, limits).front();
}

}  // namespace halflit::io::detail
