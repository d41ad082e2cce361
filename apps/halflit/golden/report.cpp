#include "apps/halflit/golden/report.hpp"

#include "apps/engine/basics/xml_text.hpp"
#include "apps/engine/pictures/html_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace halflit::cli {
namespace {

constexpr const char* kGoldenStyle = R"(section { margin: 1.5rem 0; padding: 1rem; border: 1px solid #ddd; border-left: 6px solid #b00020 }
section.within { border-left-color: #e69f00 }
.status { font-weight: 600; color: #b00020 }
.within .status { color: #8a5a00 }
pre { margin: .5rem 0; padding: .4rem .6rem; background: #f4f4f4; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 13px }
td:nth-child(2) { font-family: monospace }
td:nth-child(3), th:nth-child(3) { text-align: right }
)";

std::vector<DiffedFile> files_of(const std::vector<GoldenResult>& results) { return {results.begin(), results.end()}; }

std::size_t failures(const std::vector<GoldenResult>& results) {
    return static_cast<std::size_t>(std::count_if(results.begin(), results.end(), [](const GoldenResult& r) { return !r.passed(); }));
}

/// One sentence: "max 12 codes; 340 of 57600 pixels differ; 300 by more than 2 codes (0.52 %)".
std::string description(const GoldenResult& result) {
    std::string text = result.message;
    if (!result.diff || result.diff->count == 0) return text;
    const PictureDiff& diff = *result.diff;
    if (!text.empty()) text += "; ";
    text += fmt::format("max {} codes; {} of {} pixels differ", diff.max, diff.count, diff.pixels);
    const std::uint64_t above = diff.count_above(result.tolerance.max_codes);
    if (result.tolerance.max_codes > 0) text += fmt::format("; {} by more than {} codes", above, result.tolerance.max_codes);
    return text + fmt::format(" ({:.3g} %, allowed {:.3g} %)", 100.0 * static_cast<double>(above) / static_cast<double>(diff.pixels),
                              100 * result.tolerance.max_share);
}

/// "recorded", "framed" or "given": by the flags or the file.
const char* camera_name(const GoldenResult& result) { return result.kept ? "recorded" : result.framed ? "framed" : "given"; }

std::string picture(const std::string& file, const char* caption) {
    if (file.empty()) return fmt::format("<figure><figcaption>{}: none</figcaption></figure>\n", caption);
    return fmt::format("<figure><figcaption>{0}</figcaption><a href=\"{1}\"><img src=\"{1}\" alt=\"{0}\"></a></figure>\n", caption,
                       xml_escaped(file));
}

std::string section(const GoldenResult& result) {
    std::string html = fmt::format("<section id=\"{0}\" class=\"{1}\">\n<h2>{0} <span class=\"status\">{1}</span></h2>\n<p>{2}</p>\n",
                                   page_text(result.path), diff_status_name(result.status), page_text(description(result)));
    html += fmt::format("<pre>{}</pre>\n", page_text(golden_command_line(*result.scene)));
    if (!result.actual_picture.empty())
        html += "<div class=\"pictures\">\n" + picture(result.expected_picture, "expected") + picture(result.actual_picture, "actual") +
                picture(result.difference_picture, "difference, stretched to the full range") + "</div>\n";
    return html + "</section>\n";
}

}  // namespace

Json golden_json(const std::vector<GoldenResult>& results) {
    Json scenes = Json::array();
    for (const GoldenResult& result : results) {
        Json one{{"name", result.path},
                 {"status", diff_status_name(result.status)},
                 {"pixel_hash", result.hash.empty() ? Json(nullptr) : Json(result.hash)},
                 {"expected_hash", result.expected_hash.empty() ? Json(nullptr) : Json(result.expected_hash)},
                 {"camera", result.hash.empty() ? Json(nullptr) : Json(camera_name(result))},
                 {"ms", result.ms},
                 {"tolerance", {{"max_codes", result.tolerance.max_codes}, {"max_share", result.tolerance.max_share}}}};
        if (result.diff) one["difference"] = diff_json(*result.diff, result.tolerance);
        if (!result.message.empty()) one["message"] = result.message;
        scenes.push_back(std::move(one));
    }
    return {{"passed", failures(results) == 0}, {"sums", sums_json(files_of(results))}, {"scenes", std::move(scenes)}};
}

std::string golden_page(const GoldenList& list, const std::vector<GoldenResult>& results) {
    const std::size_t failed = failures(results);
    const std::string title = failed == 0 ? fmt::format("All {} golden pictures match", results.size())
                                          : fmt::format("{} of {} golden pictures do not match", failed, results.size());
    std::string html = page_head("halflit golden", title, kGoldenStyle);
    html += fmt::format(
        "<p>List: <code>{}</code>. The commands draw the pictures again in its folder; they frame those "
        "anew whose camera was recorded.</p>\n",
        page_text(list.folder));
    for (const bool failures_now : {true, false})
        for (const GoldenResult& result : results)
            if (result.passed() != failures_now && result.status != DiffStatus::equal) html += section(result);
    if (std::any_of(results.begin(), results.end(), [](const GoldenResult& r) { return r.status == DiffStatus::equal; }))
        html += "<h2>Equal</h2>\n<table>\n<tr><th>scene</th><th>hash of the pixels</th><th>ms</th></tr>\n";
    std::string rows;
    for (const GoldenResult& result : results)
        if (result.status == DiffStatus::equal)
            rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.1f}</td></tr>\n", page_text(result.path), result.hash, result.ms);
    return html + rows + (rows.empty() ? "" : "</table>\n") + kPageEnd;
}

std::string golden_junit(const std::vector<GoldenResult>& results) {
    std::size_t errors = 0;
    double ms = 0;
    std::string cases;
    for (const GoldenResult& result : results) {
        const bool error = result.status == DiffStatus::failed;
        errors += error ? 1 : 0;
        ms += result.ms;
        cases += fmt::format("    <testcase classname=\"golden\" name=\"{}\" time=\"{:.3f}\"", page_text(result.path), result.ms / 1e3);
        if (result.passed())
            cases += "/>\n";
        else
            cases +=
                fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n    </testcase>\n", error ? "error" : "failure",
                            diff_status_name(result.status), page_text(description(result)), page_text(golden_command_line(*result.scene)));
    }
    const std::string sums = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" time=\"{:.3f}\"", results.size(),
                                         failures(results) - errors, errors, ms / 1e3);
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"halflit golden\" {0}>\n{1}  "
        "</testsuite>\n</testsuites>\n",
        sums, cases);
}

}  // namespace halflit::cli
