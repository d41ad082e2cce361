#include "apps/engine/job/part_finder.hpp"

#include "apps/engine/basics/printable.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/flags.hpp"
#include "apps/engine/request/values.hpp"
#include "sh/time_limit.hpp"

#include <fmt/core.h>

#include <cstdint>

namespace halflit::engine {
namespace {

constexpr std::size_t kMostCandidates = 10'000;  // names that a misspelt one is compared with, which takes about 10 us each

}  // namespace

PartFinder::PartFinder(const Parts& parts) : parts_(parts) {
    TimeCheck check;
    for (std::size_t i = 0; i < parts.list().size(); ++i) {
        check();
        if (const std::string& name = parts.list()[i].name; !name.empty()) named_[name].push_back(i);
    }
}

bool PartFinder::mark_named(const std::string& name, std::vector<bool>& chosen) const {
    const auto found = named_.find(name);
    if (found == named_.end()) return false;
    for (const std::size_t part : found->second) chosen[part] = true;
    return true;
}

bool PartFinder::mark_below(const std::string& word, bool fold, std::vector<bool>& chosen) const {
    const std::vector<PartGroup>& groups = parts_.groups();
    enum class State : std::uint8_t { unknown, outside, inside };
    std::vector<State> states(groups.size(), State::unknown);
    TimeCheck check;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        check();
        if (groups[i].parent < 0) states[i] = State::outside;
        if (!groups[i].name.empty() && fits_pattern(word, groups[i].name, fold)) states[i] = State::inside;
    }
    bool any = false;
    std::vector<std::size_t> way;  // groups between the part and one whose state is known, each visited once
    for (std::size_t part = 0; part < parts_.list().size(); ++part) {
        if (parts_.list()[part].group < 0) continue;
        auto group = static_cast<std::size_t>(parts_.list()[part].group);
        for (way.clear(); states[group] == State::unknown; group = static_cast<std::size_t>(groups[group].parent)) {
            check();
            way.push_back(group);
        }
        for (const std::size_t passed : way) states[passed] = states[group];
        if (states[group] == State::inside) any = chosen[part] = true;
    }
    return any;
}

bool PartFinder::mark_word(const std::string& word, std::vector<bool>& chosen) const {
    if (mark_named(word, chosen)) return true;
    if (const auto number = parse_int(word, 1, static_cast<std::int64_t>(chosen.size()))) {
        chosen[static_cast<std::size_t>(*number - 1)] = true;
        return true;
    }
    TimeCheck check;
    for (const bool fold : {false, true}) {
        bool any = false;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            check();
            if (fits_pattern(word, parts_.list()[i].name, fold)) any = chosen[i] = true;
        }
        if (any || mark_below(word, fold, chosen)) return true;
    }
    return false;
}

std::string PartFinder::not_found(const std::string& word) const {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        if (!name.empty() && names.size() < kMostCandidates) names.push_back(printable(name));
    };
    for (const Part& part : parts_.list()) add(part.name);
    for (const PartGroup& group : parts_.groups()) add(group.name);
    std::string meant = did_you_mean(word, names);
    for (std::size_t i = 0; i < names.size() && meant.empty() && !word.empty(); ++i)
        if (fits_pattern("*" + word + "*", names[i], true)) meant = " (did you mean " + names[i] + "?)";
    const std::size_t count = parts_.list().size();
    return fmt::format("expected the name or number of a part, found '{}'{}; {}, which halflit info lists", word, meant,
                       count == 1 ? "the scene has 1 part" : fmt::format("the scene has {} parts", count));
}

Result<void> PartFinder::mark(const std::string& text, std::vector<bool>& chosen) const {
    if (mark_named(text, chosen)) return {};
    const std::vector<std::string> words = words_of(text, ',');
    if (words.empty()) return fail(ErrorCode::usage, not_found(text));
    for (const std::string& word : words)
        if (word.empty() || !mark_word(word, chosen)) return fail(ErrorCode::usage, not_found(word));
    return {};
}

}  // namespace halflit::engine
