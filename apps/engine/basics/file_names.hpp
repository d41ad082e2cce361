// Names of files: what is there, and what was probably meant.
#pragma once

#include "halflit/error.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::engine {

/// True for anything but a folder.
[[nodiscard]] bool is_file(const std::string& path);
[[nodiscard]] bool is_folder(const std::string& path);

/// True for a file that is not empty: files are written in one step, so it is whole.
[[nodiscard]] bool is_there(const std::string& path);

/// True if there is no file, or one that begins with this character, as an earlier output of the same kind does. Any other could be a file
/// that a scene is read from, which is not known before the scene is loaded. "-" and the empty path are free.
[[nodiscard]] bool is_free_or_begins_with(const std::string& path, char first);

/// True if both are the same file, or would be if they were there.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

/// True if the name ends as those of models' formats do, in any case.
[[nodiscard]] bool is_model_name(std::string_view path);

/// The models that a word of the command line names, in the order of their names: those in a folder, or those that fit a pattern with `*`
/// or `?` that no shell has replaced, whatever their case. Nothing for any other word. Reads at most 100,000 names.
[[nodiscard]] std::vector<std::string> models_named(const std::string& word);
/// Words with the models that they name in their places. Fails (usage) for a folder without models.
[[nodiscard]] Result<std::vector<std::string>> with_models_named(const std::vector<std::string>& words);

/// Paths of the files in the same folder, as they would be typed. Reads at most 1,000 names.
[[nodiscard]] std::vector<std::string> files_beside(const std::string& path);

/// " (did you mean FILE?)" if `path` is not there and a file in its folder, or one of the other `names`, is spelled alike.
[[nodiscard]] std::string did_you_mean_file(const std::string& path, std::vector<std::string> names = {});

/// Fails (io) with the reason if a file cannot be created or replaced at `path`. Standard output ("-") passes.
[[nodiscard]] Result<void> check_writable(const std::string& path);

/// The name without folder and extension: "duck" for "models/duck.glb".
[[nodiscard]] std::string stem_of(const std::string& path);

/// True if the whole text fits the pattern: `*` stands for any characters, `?` for one. fold: ASCII letters fit both their cases. Takes
/// time with the product of the lengths at most.
[[nodiscard]] bool fits_pattern(std::string_view pattern, std::string_view text, bool fold);

/// True for a name with words in braces, such as "{stem}.png".
[[nodiscard]] bool is_pattern(std::string_view name);

/// Replaces each word in braces by what `text_of` gives for it. Fails (usage) where that is nothing, with the word and `expected`, and for
/// a brace without its end.
[[nodiscard]] Result<std::string> fill_pattern(const std::string& pattern, std::string_view expected,
                                               const std::function<std::optional<std::string>(std::string_view word)>& text_of);

/// The digits of a number for the word `name` or, with zeros in front, `name:04`; nothing for another word.
[[nodiscard]] std::optional<std::string> digits_for(std::string_view word, std::string_view name, std::int64_t number);

/// The path of a file in the folder.
[[nodiscard]] std::string path_in(const std::string& folder, const std::string& name);

}  // namespace halflit::engine
