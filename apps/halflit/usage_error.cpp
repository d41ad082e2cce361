#include "apps/halflit/usage_error.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

namespace halflit::cli {
namespace {

/// Levenshtein's distance: single-character insertions, deletions and replacements.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

/// The candidate with the least edit distance; empty if that is too large for a typing error.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    std::size_t best_distance = std::min<std::size_t>(3, word.size() / 2 + 1);
    for (const std::string& candidate : candidates)
        if (const std::size_t distance = edit_distance(word, candidate); distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    return best;
}

std::vector<std::string> names_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(command->get_name());
    return names;
}

}  // namespace

std::string usage_message(const CLI::App& root, const CLI::ParseError& error) {
    const auto chosen = root.get_subcommands();
    const CLI::App& app = chosen.empty() ? root : *chosen.front();
    const std::string help = chosen.empty() ? "halflit --help" : "halflit " + app.get_name() + " --help";
    std::string message = error.what();
    const std::vector<std::string> rest = root.remaining(true);
    const bool no_command = chosen.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError);
    if (!rest.empty() && (no_command || error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))) {
        const bool flag = rest[0].starts_with("-");
        const std::string kind = flag ? "unknown flag " : chosen.empty() ? "unknown command " : "unexpected argument ";
        const std::string meant = nearest(rest[0].substr(0, rest[0].find('=')), names_of(app));
        message = kind + rest[0] + (meant.empty() ? "" : " (did you mean " + meant + "?)");
    } else if (no_command) {
        message = "no command: expected one of";
        for (const CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; })) message += " " + command->get_name();
    }
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message + "; see " + help;
}

}  // namespace halflit::cli
