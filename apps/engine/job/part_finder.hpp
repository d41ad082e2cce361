// Finds the parts that people mean by a name, a number or a pattern.
#pragma once

#include "apps/engine/job/parts.hpp"
#include "halflit/error.hpp"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace halflit::engine {

/// Refers to the parts, which must outlive it and keep their names.
class PartFinder {
public:
    explicit PartFinder(const Parts& parts);

    /// Marks the parts that `text` means. chosen: one mark for each part. The text is the name of parts, or a list of words with commas.
    /// The first of these that finds any part decides what a word means: the exact name of parts; the number of one, from 1; a pattern of
    /// names of parts; a pattern of names of groups, which means all parts below; the two patterns without regard to case. Fails (usage)
    /// for a word that finds none.
    [[nodiscard]] Result<void> mark(const std::string& text, std::vector<bool>& chosen) const;

private:
    [[nodiscard]] bool mark_named(const std::string& name, std::vector<bool>& chosen) const;
    [[nodiscard]] bool mark_word(const std::string& word, std::vector<bool>& chosen) const;
    [[nodiscard]] bool mark_below(const std::string& word, bool fold, std::vector<bool>& chosen) const;
    [[nodiscard]] std::string not_found(const std::string& word) const;

    const Parts& parts_;
    std::unordered_map<std::string_view, std::vector<std::size_t>> named_;
};

}  // namespace halflit::engine
