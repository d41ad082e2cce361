#include "tests/cli/program.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include <algorithm>
#include <set>
#include <sstream>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

const std::vector<std::string> kSmall{"--size", "64x36", "--frames", "1"};

Json rows_of(const std::string& folder) {
    const auto report = Json::parse(contents(folder + "/trade.json"), nullptr, false);
    REQUIRE(!report.is_discarded());
    REQUIRE(report["status"] == "ok");
    return report["rows"];
}

/// Makes a small run and returns its rows.
Json trade(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "trade");
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    arguments.insert(arguments.end(), {"-o", folder.path()});
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return rows_of(folder.path());
}

const Json& row_named(const Json& rows, const std::string& name) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Json& row) { return row["name"] == name; });
    INFO(name);
    REQUIRE(found != rows.end());
    return *found;
}

std::set<std::string> names_of(const Json& rows) {
    std::set<std::string> names;
    for (const Json& row : rows) names.insert(row["name"].get<std::string>());
    return names;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
    return n;
}

double time_of(const Json& row) { return row["ratio"]; }
double error_of(const Json& row) { return row["error"]["p999"]; }

}  // namespace

TEST_CASE("trade: table and report are complete, and list the same rows", "[cli][trade]") {
    const TemporaryFolder folder;
    const Json rows = trade(folder, {"demo", "--quick", "--samples", "1", "--shadow-size", "1024"});
    CHECK(folder.names() == std::vector<std::string>{"trade.json", "trade.md"});
    const std::string table = contents(folder.file("trade.md"));
    CHECK(count(table, "\n|") == rows.size() + 2);
    CHECK(table.find("nan") == std::string::npos);

    // Each setting alone, and every budget.
    const std::set<std::string> wanted{"reference",         "exact",
                                       "gouraud",           "flat",
                                       "bilinear",          "nearest",
                                       "no shadows",        "hard shadows",
                                       "shadow map 512",    "within 0.1 codes",
                                       "within 0.25 codes", "within 0.5 codes",
                                       "within 1 code",     "within 2 codes",
                                       "within 4 codes",    "within 8 codes",
                                       "anisotropy 1",      "anisotropy 1, shadow map 512"};
    std::set<std::string> found;
    for (const std::string& name : names_of(rows)) found.insert(name);
    CHECK(found == wanted);
    for (const Json& row : rows) {
        INFO(row.dump());
        for (const char* key :
             {"name",           "flags",          "lobe",    "accuracy",    "max_error",         "order",      "orders_used",
              "rate",           "texture_filter", "shadows", "shadow_size", "lobes_computed_as", "samples",    "anisotropy",
              "specular_power", "frames",         "ms",      "ratio",       "ratio_range",       "wall_ratio", "changes_nothing",
              "error",          "bound",          "front"})
            CHECK(row.contains(key));
        for (const char* key : {"max", "mean", "p999", "psnr", "share_off_by_one"}) CHECK(row["error"].contains(key));
        CHECK(row["ms"].get<double>() > 0);
        CHECK(time_of(row) > 0);
        CHECK(row["error"]["mean"] <= row["error"]["max"]);
        CHECK(error_of(row) <= row["error"]["max"]);
        CHECK(count(table, "| " + row["name"].get<std::string>() + " |") == 1);
        if (row["bound"].is_null()) continue;
        CHECK(row["bound"]["kept"] == (row["bound"]["off_exact"] <= row["bound"]["bound_codes"]));
        CHECK(row["bound"]["bound_codes"] <= row["max_error"]);
    }
    CHECK(row_named(rows, "within 0.5 codes")["flags"] == "--max-error 0.5");
    CHECK(table.find("| within 0.5 codes | `--max-error 0.5` |") != std::string::npos);
    CHECK(row_named(rows, "hard shadows")["flags"] == "--shadows hard");
    CHECK(row_named(rows, "nearest")["flags"] == "--texture-filter nearest");
    // Without shadows, those of the balls are missing.
    CHECK(error_of(row_named(rows, "no shadows")) > 10);
}

TEST_CASE("trade: the fewer bands of an environment, the larger the error", "[cli][trade]") {
    const TemporaryFolder folder;
    const Json rows =
        trade(folder, {"sphere:500", "--env", "sky", "--env-sun", "off", "--specular", "none", "--lobe", "lambert", "--quick"});
    double before = 1000;
    for (int order = 1; order <= 10; ++order) {
        const Json& row = row_named(rows, "order " + std::to_string(order));
        INFO(row.dump());
        CHECK(row["order"] == order);
        CHECK(row["orders_used"] == Json{order});
        CHECK(row["flags"] == "--sh-order " + std::to_string(order));
        // Lambert's lobe has no odd bands above the first, so these orders add nothing. [RH01]
        const double mean = row["error"]["mean"];
        if (order == 4 || order == 6 || order == 8 || order == 10)
            CHECK(mean == Approx(before).margin(0.01));
        else
            CHECK(mean < before);
        before = mean;
    }
    CHECK(before < 1);  // the error at the sun's edge
    CHECK(row_named(rows, "exact")["order"] == "auto");
}

TEST_CASE("trade: times are relative to exact, errors to the reference, and a diffuse sphere is within a code", "[cli][trade]") {
    const TemporaryFolder folder;
    const Json rows = trade(folder, {"sphere:2000", "--specular", "none", "--quick"});
    const Json& reference = row_named(rows, "reference");
    CHECK(reference["error"]["max"] == 0);
    CHECK(reference["error"]["psnr"].is_null());
    const Json& exact = row_named(rows, "exact");
    CHECK(exact["ratio"] == 1.0);
    CHECK(exact["flags"] == "");
    // float32 against float64: a few units in the seventh digit, times at most 112 codes.
    CHECK(exact["error"]["max"].get<double>() > 0);
    CHECK(exact["error"]["max"].get<double>() < 0.01);
    CHECK(exact["error"]["psnr"].get<double>() > 100);
    CHECK(row_named(rows, "flat")["error"]["share_off_by_one"].get<double>() > 0.3);
    for (const Json& row : rows)
        if (!row["bound"].is_null()) CHECK(row["bound"]["kept"] == true);
    // The sphere has no texture and no environment, so neither is varied.
    for (const Json& row : rows) {
        CHECK(row["texture_filter"] == "full");
        CHECK(row["order"] == "auto");
    }
}

TEST_CASE("trade: no row beats a row of the Pareto front in time and error, and all other rows are dominated", "[cli][trade]") {
    const TemporaryFolder folder;
    const Json rows = trade(folder, {"sphere:500", "--lobes", "lambert,sloan:0.3"});
    std::size_t on_front = 0;
    for (const Json& row : rows) {
        INFO(row.dump());
        const bool dominated = std::any_of(rows.begin(), rows.end(), [&](const Json& other) {
            return other["lobe"] == row["lobe"] && time_of(other) <= time_of(row) && error_of(other) <= error_of(row) &&
                   (time_of(other) < time_of(row) || error_of(other) < error_of(row));
        });
        CHECK(row["front"] == !dominated);
        on_front += row["front"] ? 1u : 0u;
    }
    CHECK(on_front >= 3);  // each lobe has a row on the front
    std::set<std::string> lobes;
    for (const Json& row : rows) lobes.insert(row["lobe"].get<std::string>());
    CHECK(lobes == std::set<std::string>{"own", "lambert", "sloan:0.3"});
    CHECK(row_named(rows, "lobe lambert")["lobes_computed_as"] == Json{"t"});
    CHECK(row_named(rows, "lobe sloan:0.3")["lobes_computed_as"] == Json{"t^n (exact)"});
    // The error of a lobe is relative to its own reference, not to the scene's own lobe.
    CHECK(row_named(rows, "lobe lambert")["error"]["max"].get<double>() < 0.5);
}

TEST_CASE("trade: the combinations are the product of what the scene has", "[cli][trade]") {
    const auto rows_with = [](std::vector<std::string> flags) {
        const TemporaryFolder folder;
        flags.insert(flags.begin(), "sphere:100");
        if (std::find(flags.begin(), flags.end(), "--shadow-size") == flags.end()) flags.insert(flags.end(), {"--shadow-size", "2048"});
        return trade(folder, flags).size();
    };
    // Sum of: reference; rates; four other kinds of shadow; seven budgets; one sample, and that with a smaller map.
    const std::size_t kinds_alone = 4, budgets = 7, samples = 1, both = 1;  // hard, off, 1024, 512
    CHECK(rows_with({}) == 1 + 3 + kinds_alone + budgets + samples + both);
    CHECK(rows_with({"--quick"}) == 1 + 1 + 2 + kinds_alone + budgets + samples + both);
    CHECK(rows_with({"--all"}) == 1 + 3 * 7 + budgets + samples + both);  // two modes of three sizes, and off
    CHECK(rows_with({"--shadows", "off"}) == 1 + 3 + budgets + samples);
    CHECK(rows_with({"--shadow-size", "1024", "--quick"}) == 1 + 1 + 2 + (kinds_alone - 1) + budgets + samples + both);
}

TEST_CASE("trade: the summary offers settings that were surely faster, each once", "[cli][trade]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"trade", "sphere:2000", "--quick", "--size", "64x36", "--frames", "3", "-o", folder.path()});
    REQUIRE(outcome.code == 0);
    const Json rows = rows_of(folder.path());
    const Json& exact = row_named(rows, "exact");
    const auto surely_cheaper = [&](const Json& row) {
        return !row["changes_nothing"].get<bool>() && row["ratio_range"][1] < 1.0 && row["ratio"] < exact["ratio_range"][0];
    };
    std::istringstream lines(outcome.out);
    std::set<std::string> offered;
    std::size_t count_of_lines = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t flags = line.find(" --");
        if (flags == std::string::npos || line.starts_with("too noisy")) continue;
        offered.insert(line.substr(flags + 1));
        ++count_of_lines;
    }
    CHECK(offered.size() == count_of_lines);
    for (const Json& row : rows)
        if (offered.contains(row["flags"].get<std::string>())) CHECK(surely_cheaper(row));
    const bool any = std::any_of(rows.begin(), rows.end(), [&](const Json& row) { return surely_cheaper(row) && error_of(row) <= 8; });
    CHECK(offered.empty() != any);
    for (const char* const begin : {"free (within 0.1 codes): ", "for one code: ", "not worth it: "}) CHECK(count(outcome.out, begin) == 1);
}

TEST_CASE("trade: progress is one line, and only if asked for or on a terminal", "[cli][trade]") {
    const TemporaryFolder folder;
    std::vector<std::string> arguments{"trade", "sphere:100", "--quick", "-o", folder.path()};
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    const Outcome silent = run(arguments);
    CHECK(silent.err.find(" left") == std::string::npos);
    CHECK(count(silent.err, "\n") == 2);  // one line for each file
    CHECK(count(silent.out, "exact takes") == 1);
    arguments.emplace_back("--progress");
    const Outcome told = run(arguments);
    CHECK(told.err.find("100 %, 0 s left") != std::string::npos);
    CHECK(count(told.err, "\n") == 2);
    CHECK(told.err.find('\r') != std::string::npos);
}

TEST_CASE("trade: flags that it varies itself and invalid values are refused before anything is drawn", "[cli][trade]") {
    const TemporaryFolder folder;
    const std::vector<std::vector<std::string>> refused = {{"--accuracy", "reference"},
                                                           {"--max-error", "1"},
                                                           {"--texture-filter", "nearest"},
                                                           {"--shading", "flat"},
                                                           {"--sh-order", "3"},
                                                           {"--quick", "--all"},
                                                           {"--frames", "0"},
                                                           {"--frames", "x"},
                                                           {"-o", "-"},
                                                           {"-o", ""},
                                                           {"--lobes", ""},
                                                           {"--lobes", "lambert,"},
                                                           {"--lobes", "phong"},
                                                           {"--lobes", "sloan:2"},
                                                           {"--lobes", "sloan:0.5:1:1"}};
    for (const auto& flags : refused) {
        std::vector<std::string> arguments{"trade", "sphere:100"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome outcome = run(arguments, {.folder = folder.path()});
        INFO(flags.front() << ": " << outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(flags.front()) != std::string::npos);
    }
    CHECK(run({"trade"}, {.folder = folder.path()}).code == 2);
    CHECK(folder.names().empty());
    CHECK(run({"trade", "missing.glb"}, {.folder = folder.path()}).code == 4);
    CHECK(folder.names().empty());
}
