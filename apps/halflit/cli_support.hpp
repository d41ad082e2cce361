// CLI11 with our own reading of values, so that every flag is checked in one way (apps/halflit/values.hpp).
#pragma once

#include "halflit/error.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace halflit::cli {

/// Takes one value of a flag; its error becomes "--flag: expected ..., found ...".
using ReadValue = std::function<Result<void>(const std::string& text)>;

/// A flag with one value that may be given once.
inline CLI::Option* add_value(CLI::App& app, const std::string& names, const std::string& form, const std::string& help, ReadValue read) {
    const std::string shown = names.substr(names.rfind(',') + 1);
    const auto take = [shown, read = std::move(read)](const std::string& text) {
        const Result<void> result = read(text);
        if (!result) throw CLI::ValidationError(shown, result.error().message);
    };
    return app.add_option_function<std::string>(names, take, help)->type_name(form);
}

/// The same for a flag that may be repeated; each use has one value.
inline CLI::Option* add_values(CLI::App& app, const std::string& names, const std::string& form, const std::string& help, ReadValue read) {
    const auto take = [names, read = std::move(read)](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            const Result<void> result = read(text);
            if (!result) throw CLI::ValidationError(names, result.error().message);
        }
    };
    return app.add_option_function<std::vector<std::string>>(names, take, help)->type_name(form)->allow_extra_args(false);
}

/// Stores a parsed value in `target`, or returns its error; for use in a ReadValue.
template <class Target, class T>
Result<void> assign(Target& target, const Result<T>& value) {
    if (!value) return tl::unexpected(value.error());
    target = *value;
    return {};
}

}  // namespace halflit::cli
