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
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace halflit::io::detail {
namespace {

constexpr const char* kCadProgram = "halflit-import-cad";
constexpr const char* kProtocol = "1";

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

bool is_program(const std::string& path) {
    platform::FileStatus status;
    return platform::status_of(path, status) == 0 && status.kind == platform::FileKind::file && (status.mode & 0111u) != 0;
}

/// Beside this program or library, in its libexec, or in a folder of PATH; empty: nowhere.
std::string find_program(const std::string& name) {
    std::vector<std::string> folders;
    if (const std::string own = platform::own_folder(); !own.empty())
        for (const char* const place : {"", "/../bin", "/../libexec/halflit", "/../../libexec/halflit"}) folders.push_back(own + place);
    const std::string path = variable("PATH");
    for (std::string_view rest = path; !rest.empty();) {
        const std::string_view folder = rest.substr(0, rest.find(':'));
        rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
        if (platform::is_absolute(folder)) folders.emplace_back(folder);
    }
    for (const std::string& folder : folders)
        if (std::string program = folder + "/" + name; is_program(program)) return platform::real_path(program);
    return {};
}

/// A small file may take 10 s and 1 GB, and a large one more by its size. Libraries of a reader take a third of a gigabyte of addresses.
platform::ChildLimits limits_for(std::size_t bytes, const LoadLimits& limits) {
    constexpr std::size_t kMemory = std::size_t{5} << 28, kMemoryByByte = 300, kWorkByByte = 20'000;
    constexpr std::uint64_t kWork = 10'000'000'000, kSecond = 1'000'000'000;
    const std::uint64_t work = limits.max_work > 0 ? limits.max_work : kWork + kWorkByByte * std::uint64_t{bytes};
    return {.memory_bytes = kMemory + kMemoryByByte * bytes,
            .output_bytes = limits.max_file_bytes,
            .cpu_s = static_cast<unsigned>(std::min<std::uint64_t>(work / kSecond + 1, 1'000'000))};
}

/// The last line, which tells why.
std::string reason_in(const std::string& messages) {
    const std::size_t end = messages.find_last_not_of(" \n\r\t");
    if (end == std::string::npos) return {};
    const std::size_t begin = messages.rfind('\n', end) + 1;  // npos + 1 is 0
    return printable(messages.substr(begin, end + 1 - begin), 200);
}

std::vector<std::byte> import_by(const std::string& program, const ModelFile& file, const LoadOptions& options) {
    const platform::ChildLimits limits = limits_for(file.bytes.size(), options.limits);
    std::vector<std::string> words{program, kProtocol, "--pixels", fmt::format("{:g}", options.detail_px)};
    if (options.exact_measures) words.emplace_back("--measure");
    const ImportCache cache(options.import_cache ? user_import_cache() : "", words, file.bytes);
    if (auto kept = cache.find()) return *std::move(kept);
    platform::ChildResult result = platform::run_confined(words, file.bytes, limits);
    const std::string name = printable(program.substr(program.rfind('/') + 1)), reason = reason_in(result.messages);
    using End = platform::ChildResult::End;
    switch (result.end) {
        case End::not_started:
            refuse("", fmt::format("{} cannot be run: {}", printable(program), platform::errno_text(result.number)), ErrorCode::io);
        case End::out_of_time:
            refuse("", fmt::format("{} took more than {} s of a core, the limit for a file of this size (max_work)", name, limits.cpu_s),
                   ErrorCode::limit);
        case End::too_much_output:
            refuse("", fmt::format("{} made more than {} bytes (max_file_bytes)", name, limits.output_bytes), ErrorCode::limit);
        case End::signal:
            refuse("", fmt::format("{} ended by signal {}", name, result.number));
        case End::code:
            break;
    }
    constexpr int kLimit = 5;
    if (result.number == 0) {
        cache.keep(result.output);
        return std::move(result.output);
    }
    refuse("", fmt::format("{}: {}", name, reason.empty() ? fmt::format("exit code {}", result.number) : reason),
           result.number == kLimit ? ErrorCode::limit : ErrorCode::bad_input);
}

/// Of the user's file. Its faults are errors of each load, as they would otherwise be silent.
std::vector<Importer> configured_importers() {
    const std::string own = variable("XDG_CONFIG_HOME"), home = variable("HOME");
    const std::string folder = !own.empty() || home.empty() ? own : home + "/.config";
    platform::FileStatus status;
    const std::string path = folder + "/halflit/importers";
    std::vector<Importer> importers;
    if (folder.empty() || platform::status_of(path, status) != 0) return importers;
    constexpr std::size_t kMostBytes = 1 << 16;
    const auto bytes = take(read_file(path, kMostBytes), path);
    Lines lines(as_text(bytes));
    for (std::string_view line; lines.next(line);) {
        const std::string text(Words(line).rest());
        if (!text.empty() && text[0] != '#') importers.push_back(take(Importer::from(text), path));
    }
    return importers;
}

}  // namespace

std::optional<LoadedScene> read_cad(const ModelFile& file, const LoadOptions& options) {
    const std::string program = find_program(kCadProgram);
    if (program.empty()) return std::nullopt;
    LoadOptions upright = options;
    if (!upright.up) upright.up = UpAxis::z;
    LoadedScene loaded = read_gltf(import_by(program, file, options), "", upright);
    loaded.info.unit_m = 1e-3;
    loaded.info.detail_px = options.detail_px;
    return loaded;
}

std::optional<LoadedScene> read_by_importer(const ModelFile& file, const LoadOptions& options) {
    std::vector<Importer> importers = options.importers;
    const std::vector<Importer> configured = configured_importers();
    importers.insert(importers.end(), configured.begin(), configured.end());
    for (const Importer& importer : importers) {
        if (!ends_with_word(file.name, importer.extension)) continue;
        LoadedScene loaded = read_gltf(import_by(importer.program, file, options), "", options);
        loaded.info.format = importer.extension;
        loaded.info.detail_px = options.detail_px;
        return loaded;
    }
    return std::nullopt;
}

}  // namespace halflit::io::detail

halflit::Result<halflit::Importer> halflit::Importer::from(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals < 2 || text[0] != '.' || equals + 1 == text.size())
        return fail(ErrorCode::usage, fmt::format("expected .EXTENSION=PROGRAM, found '{}'", io::printable(text)));
    Importer importer{text.substr(0, equals), platform::real_path(text.substr(equals + 1))};
    if (!io::detail::is_program(importer.program))
        return fail(ErrorCode::usage, fmt::format("'{}' is no program", io::printable(text.substr(equals + 1))));
    return importer;
}
