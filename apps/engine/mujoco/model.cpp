#include "apps/engine/mujoco/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace halflit::engine::mujoco {
namespace {

// From 3.3.0 on both sides are drawn into shadow maps, with the offset that MuJoCo sets where OpenGL has clip control.
constexpr Look kLooks[] = {
    {"2.2.2", 20200, false, false, false, true, 0.0f, 1.0f},
    {"3.3.2", 30300, false, false, false, false, 1.5f, 4.0f},
    {"3.3.3", 30303, true, false, false, false, 1.5f, 4.0f},
    {"3.12.0", 31200, true, true, true, false, 1.5f, 4.0f},
};

struct MemberRow {
    const char* name;
    std::int32_t Layout::*place;
    std::int32_t Layout::*whole;
    std::int32_t bytes;
    bool is_needed;
};
constexpr MemberRow kMembers[] = {
#define MEMBER(type, name, count, whole, place, is_needed) {#name, &Layout::name, &Layout::whole, sizeof(type) * count, is_needed},
#include "apps/engine/mujoco/layout_members.def"
};

struct CountRow {
    const char* name;
    std::int32_t count;
    std::int32_t least = 0;
};

struct NumberRow {
    const char* name;
    double value;
};

struct ArrayRow {
    const char* name;
    const void* array;
    std::uint64_t count;
};

/// Slices, stacks, quads. At 250, a shape has some 100,000 triangles; more cannot be seen.
constexpr int kFinest = 250;
constexpr float kWidestLine = 100;                             // pixels
constexpr int kLeastShadowMap = 4, kLargestShadowMap = 16384;  // texels on a side, if there are any

/// Takes a number of at most two digits off the text's begin; -1: it does not begin with one.
int take_number(std::string_view& text) {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (digits < 1 || digits > 2) return -1;
    int value = 0;
    std::from_chars(text.data(), text.data() + digits, value);
    text.remove_prefix(digits);
    return value;
}

/// The same behind a point.
int take_part(std::string_view& text) {
    if (!text.starts_with('.')) return -1;
    text.remove_prefix(1);
    return take_number(text);
}

}  // namespace

Result<Look> look_of(std::string_view name) {
    std::string_view rest = name;
    const int major = take_number(rest), minor = take_part(rest), patch = rest.empty() ? 0 : take_part(rest);
    const bool is_release = major >= 0 && minor >= 0 && patch >= 0 && rest.empty();
    const int release = is_release ? 10000 * major + 100 * minor + patch : 0;
    const Look* found = nullptr;
    for (const Look& look : kLooks)
        if (look.since <= release) found = &look;
    if (found != nullptr && major <= 3) return *found;
    return fail(ErrorCode::usage, fmt::format("look: '{}', expected a release of MuJoCo from 2.2 on, below 4, such as {} or {}", name,
                                              kLooks[0].name, std::end(kLooks)[-1].name));
}

Result<void> check_layout(const Layout& layout) {
    for (const MemberRow& row : kMembers) {
        const std::int32_t place = layout.*row.place, whole = layout.*row.whole;
        if (place == -1 && !row.is_needed) continue;
        if (place < 0 || place > whole - row.bytes)
            return fail(ErrorCode::usage, fmt::format("layout: {} is {} in a struct of {} bytes", row.name, place, whole));
    }
    return {};
}

Result<void> check_range(std::int64_t begin, std::int64_t count, std::uint64_t size, std::string_view what) {
    const auto most = static_cast<std::int64_t>(std::min<std::uint64_t>(size, std::numeric_limits<std::int64_t>::max()));
    if (begin >= 0 && count >= 0 && begin <= most && count <= most - begin) return {};
    return fail(ErrorCode::bad_input, fmt::format("{}: {} from {} on, the model has {}", what, count, begin, size));
}

Result<void> check_model(const Model& model) {
    if (auto ok = check_layout(model.layout); !ok) return ok;
    const CountRow counts[] = {
#define COUNT(name) {#name, model.name},
#include "apps/engine/mujoco/model_members.def"
    };
    for (const CountRow& row : counts)
        if (row.count < 0) return fail(ErrorCode::bad_input, fmt::format("{} is {}, expected at least 0", row.name, row.count));
    const ArrayRow arrays[] = {
#define OPTIONAL(type, name, count, each)
#define ARRAY(type, name, count, each) {#name, model.name, static_cast<std::uint64_t>(model.count)},
#include "apps/engine/mujoco/model_members.def"
    };
    for (const ArrayRow& row : arrays)
        if (row.count > 0 && row.array == nullptr) return fail(ErrorCode::bad_input, fmt::format("{} is null", row.name));
    const CountRow fineness[] = {{"numslices", model.numslices, 3}, {"numstacks", model.numstacks, 2}, {"numquads", model.numquads, 1}};
    for (const CountRow& row : fineness)
        if (row.count < row.least || row.count > kFinest)
            return fail(ErrorCode::bad_input, fmt::format("{} is {}, expected {} to {}", row.name, row.count, row.least, kFinest));
    const auto sum = [](const float* color) { return static_cast<double>(color[0] + color[1] + color[2] + color[3]); };
    const NumberRow numbers[] = {
#define NUMBER(type, name, value) {#name, static_cast<double>(model.name)},
#include "apps/engine/mujoco/model_members.def"
        {"fog_rgba's sum", sum(model.fog_rgba)},
        {"haze_rgba's sum", sum(model.haze_rgba)},
    };
    for (const NumberRow& row : numbers)
        if (!std::isfinite(row.value)) return fail(ErrorCode::bad_input, fmt::format("{} is {}, expected a number", row.name, row.value));
    if (model.linewidth < 0 || model.linewidth > kWidestLine)
        return fail(ErrorCode::bad_input, fmt::format("linewidth is {}, expected 0 to {}", model.linewidth, kWidestLine));
    if (model.shadowsize != 0 && (model.shadowsize < kLeastShadowMap || model.shadowsize > kLargestShadowMap))
        return fail(ErrorCode::bad_input,
                    fmt::format("shadowsize is {}, expected 0, or {} to {}", model.shadowsize, kLeastShadowMap, kLargestShadowMap));
    return {};
}

}  // namespace halflit::engine::mujoco
