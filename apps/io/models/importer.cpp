#include "apps/io/models/importer.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/gltf/loader.hpp"
#include "apps/io/models/import_cache.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/platform/child.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace halflit::io::detail {
namespace {

constexpr const char* kCadProgram = "halflit-import-cad";
constexpr const char* kProtocol = "1";

bool is_program(const std::string& path) {
    platform::FileStatus status;
    return platform::status_of(path, status) == 0 && status.kind == platform::FileKind::file && (status.mode & 0111u) != 0;
}

/// Beside this program or library, in its libexec, or in a folder of PATH; empty: nowhere.
std::string find_program(const std::string& name) {
    std::vector<std::string> folders;
    if (const std::string own = platform::own_folder(); !own.empty())
        for (const char* const place : {"", "/../bin", "/../libexec/halflit", "/../../libexec/halflit"}) folders.push_back(own + place);
    const char* const path = std::getenv("PATH");
    for (std::string_view rest = path == nullptr ? "" : path; !rest.empty();) {
        const std::string_view folder = rest.substr(0, rest.find(':'));
        rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
        if (platform::is_absolute(folder)) folders.emplace_back(folder);
    }
    for (const std::string& folder : folders)
        if (std::string program = folder + "/" + name; is_program(program)) return platform::real_path(program);
    return {};
}

/// A small file may take 10 s and 1.25 GiB, of which libraries take a third, and a large one more by its size.
platform::ChildLimits limits_for(std::uint64_t bytes, const LoadLimits& limits) {
    constexpr std::uint64_t kMemory = std::uint64_t{5} << 28, kMemoryByByte = 300, kWorkByByte = 20'000;
    constexpr std::uint64_t kWork = 10'000'000'000, kSecond = 1'000'000'000, kMostBytes = std::uint64_t{1} << 40;
    constexpr std::uint64_t kOutput = std::uint64_t{1} << 28, kOutputByByte = 100;
    const std::uint64_t counted = std::min(bytes, kMostBytes);
    const std::uint64_t work = limits.max_work > 0 ? limits.max_work : kWork + kWorkByByte * counted;
    const std::uint64_t memory = std::min<std::uint64_t>(kMemory + kMemoryByByte * counted, std::numeric_limits<std::size_t>::max());
    return {.memory_bytes = static_cast<std::size_t>(memory),
            .output_bytes = static_cast<std::size_t>(std::min<std::uint64_t>(limits.max_file_bytes, kOutput + kOutputByByte * counted)),
            .cpu_s = static_cast<unsigned>(std::min<std::uint64_t>((work + kSecond - 1) / kSecond, 1'000'000))};
}

std::string shown_name(const std::string& program) { return printable(program.substr(program.rfind('/') + 1)); }

/// The last line, which tells why.
std::string reason_in(const std::string& messages) {
    const std::size_t end = messages.find_last_not_of(" \n\r\t");
    if (end == std::string::npos) return {};
    const std::size_t begin = messages.rfind('\n', end) + 1;  // npos + 1 is 0
    return printable(messages.substr(begin, end + 1 - begin), 200);
}

/// The GLB that the program makes of the file.
std::vector<std::byte> run_importer(const std::vector<std::string>& words, const ModelFile& file, const LoadOptions& options) {
    const platform::ChildLimits limits = limits_for(file.bytes.size(), options.limits);
    const std::string& program = words[0];
    platform::ChildResult result = platform::run_confined(words, file.bytes, limits);
    const std::string name = shown_name(program), reason = reason_in(result.messages);
    using End = platform::ChildResult::End;
    switch (result.end) {
        case End::not_started:
            refuse("", fmt::format("{} cannot be run: {}", printable(program), platform::errno_text(result.number)), ErrorCode::io);
        case End::out_of_time:
            refuse("", fmt::format("{} took more than {} s of a core, the limit for a file of this size (max_work)", name, limits.cpu_s),
                   ErrorCode::limit);
        case End::too_much_output:
            refuse("", fmt::format("{} made more than {} bytes, the limit for a file of this size", name, limits.output_bytes),
                   ErrorCode::limit);
        case End::signal:
            refuse("", fmt::format("{} ended by signal {}", name, result.number));
        case End::code:
            break;
    }
    constexpr int kLimit = 5;
    if (result.number == 0) return std::move(result.output);
    refuse("", fmt::format("{}: {}", name, reason.empty() ? fmt::format("exit code {}", result.number) : reason),
           result.number == kLimit ? ErrorCode::limit : ErrorCode::bad_input);
}

/// more: words behind those of the protocol.
LoadedScene import_by(const std::string& program, const std::vector<std::string>& more, const ModelFile& file, const LoadOptions& options) {
    std::vector<std::string> words{program, kProtocol, "--pixels", fmt::format("{:.0f}", std::max(options.detail_px, 1.0))};
    words.insert(words.end(), more.begin(), more.end());
    // What a small file becomes may take no more work and memory than a small file.
    LoadOptions of_file = options;
    of_file.allow_external.clear();
    constexpr std::uint64_t kFree = 4'000'000, kMemory = std::uint64_t{1} << 28;
    const std::uint64_t bytes = file.bytes.size();
    of_file.limits.max_work = allowed_work(options.limits, kFree + 4 * bytes);
    of_file.limits.max_geometry_bytes = std::min(options.limits.max_geometry_bytes, kMemory + 1000 * bytes);
    const auto scene_of = [&](std::span<const std::byte> glb) {
        LoadedScene loaded = read_imported(glb, of_file);
        if (options.strict && !loaded.warnings.empty()) refuse("", loaded.warnings[0]);
        loaded.info.detail_px = options.detail_px;
        return loaded;
    };
    const ImportCache cache(options.import_cache ? user_import_cache() : "", words, file.bytes);
    if (const auto kept = cache.find()) return scene_of(*kept);
    const std::vector<std::byte> glb = run_importer(words, file, options);
    try {
        LoadedScene loaded = scene_of(glb);
        cache.keep(glb);
        return loaded;
    } catch (const LoadFailure& failure) {
        refuse("", fmt::format("what {} made of it cannot be read: {}", shown_name(program), failure.error.message), failure.error.code);
    }
}

/// Those of the user's file that are for a file of this name.
std::vector<Importer> configured_importers(std::string_view name) {
    const std::string folder = user_folder("XDG_CONFIG_HOME", ".config");
    platform::FileStatus status;
    const std::string path = folder + "/halflit/importers";
    std::vector<Importer> importers;
    if (folder.empty() || platform::status_of(path, status) != 0) return importers;
    constexpr std::size_t kMostBytes = 1 << 16;
    const auto bytes = take(read_file(path, kMostBytes), path);
    Lines lines(as_text(bytes));
    for (std::string_view line; lines.next(line);) {
        const std::string text(Words(line).rest());
        if (text.starts_with('.') && ends_with_word(name, text.substr(0, text.find_first_of(" ="))))
            importers.push_back(take(Importer::from(text), path));
    }
    return importers;
}

}  // namespace

std::optional<LoadedScene> read_cad(const ModelFile& file, const LoadOptions& options) {
    const std::string program = platform::can_run_children() ? find_program(kCadProgram) : "";
    if (program.empty()) return std::nullopt;
    LoadOptions upright = options;
    if (!upright.up) upright.up = UpAxis::z;
    std::vector<std::string> more;
    if (options.exact_measures) more.emplace_back("--measure");
    LoadedScene loaded = import_by(program, more, file, upright);
    loaded.info.unit_m = 1e-3;
    return loaded;
}

std::optional<LoadedScene> read_by_importer(const ModelFile& file, const LoadOptions& options) {
    std::vector<Importer> importers = options.importers;
    const std::vector<Importer> configured = configured_importers(file.name);
    importers.insert(importers.end(), configured.begin(), configured.end());
    for (const Importer& importer : importers) {
        if (!ends_with_word(file.name, importer.extension)) continue;
        LoadedScene loaded = import_by(importer.program, {}, file, options);
        loaded.info.format = importer.extension;
        loaded.info.exact.clear();
        return loaded;
    }
    return std::nullopt;
}

}  // namespace halflit::io::detail

halflit::Result<halflit::Importer> halflit::Importer::from(const std::string& text) {
    if (!platform::can_run_children()) return fail(ErrorCode::usage, "importers cannot be run on this system");
    const std::size_t equals = text.find('=');
    const auto trimmed = [](std::string_view part) { return std::string(io::detail::Words(part).rest()); };
    const std::string extension = trimmed(text.substr(0, equals)), path = equals == text.npos ? "" : trimmed(text.substr(equals + 1));
    if (extension.size() < 2 || extension[0] != '.' || path.empty())
        return fail(ErrorCode::usage, fmt::format("expected .EXTENSION=PROGRAM, found '{}'", io::printable(text)));
    Importer importer{extension, platform::real_path(path)};
    if (!io::detail::is_program(importer.program)) return fail(ErrorCode::usage, fmt::format("'{}' is no program", io::printable(path)));
    return importer;
}
