#include "apps/halflit/mcp/tool.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/io/files/atomic_file.hpp"

#include <algorithm>
#include <utility>

namespace halflit::cli {

std::vector<const CallRow*> all_tools() {
    std::vector<const CallRow*> tools;
    for (const CallRow& row : all_calls())
        if (!row.tool.empty()) tools.push_back(&row);
    return tools;
}

Call make_call(const CallRow& tool, std::string& output) {
    Call call = tool.make();
    if (tool.has_picture)
        call.groups.front().flags.push_back({"--output", kPictureForm,
                                             "Also write the picture: a .png, .jpg or .webp file below the server's folder",
                                             engine::read_text(output)});
    return call;
}

Json tool_json(const CallRow& tool) {
    std::string output;
    return {{"name", tool.tool},
            {"description", tool.help},
            {"inputSchema", arguments_schema(tool, make_call(tool, output))},
            {"annotations", {{"readOnlyHint", !tool.has_picture}, {"openWorldHint", false}}}};
}

Result<OutputFormat> format_of_output(const std::string& output) {
    if (output.empty()) return OutputFormat::png;
    const auto format = output_format_of(output);
    if (!format) return format;
    if (*format == OutputFormat::png || *format == OutputFormat::jpg || *format == OutputFormat::webp) return format;
    return fail(ErrorCode::usage, "output: expected a .png, .jpg or .webp file");
}

Result<ToolAnswer> tool_answer(Answer answer, const std::string& output, OutputFormat format) {
    ToolAnswer finished{std::move(answer.notes), std::move(answer.report), {}};
    if (!answer.picture) return finished;
    auto bytes = encode_image(*answer.picture, format);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!output.empty()) {
        if (std::any_of(answer.inputs.begin(), answer.inputs.end(), [&](const auto& input) { return same_file(output, input); }))
            return fail(ErrorCode::io, output + ": the scene needs it, and it is not overwritten");
        if (const auto written = io::write_file(output, *bytes); !written) return tl::unexpected(written.error());
        if (finished.report.contains("output")) finished.report["output"] = output;
    }
    const char* const mime_type = format == OutputFormat::png ? "image/png" : format == OutputFormat::jpg ? "image/jpeg" : "image/webp";
    finished.picture = {std::move(*bytes), mime_type};
    return finished;
}

}  // namespace halflit::cli
