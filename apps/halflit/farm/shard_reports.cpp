#include "apps/halflit/farm/shard_reports.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/io/files/file_access.hpp"
#include "halflit/target.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace halflit::cli {
namespace {

constexpr std::size_t kMostReportBytes = std::size_t{1} << 30;
constexpr std::size_t kMostPlaces = 10'000'000;  ///< frames or scenes of a run
constexpr std::size_t kMostPictureBytes = std::size_t{4} << 30;

Region region_of(const Json& json) { return {json.at(0).get<int>(), json.at(1).get<int>(), json.at(2).get<int>(), json.at(3).get<int>()}; }

FilmFrame frame_of(const Json& report) {
    const Json& film = report.at("film");
    const Json& seconds = film.at("seconds_each");
    FilmFrame frame{report.at("frame").get<std::int64_t>(),
                    {film.at("first").get<std::int64_t>(), film.at("last").get<std::int64_t>(), film.at("step").get<std::int64_t>()},
                    {seconds.at(0).get<std::int64_t>(), seconds.at(1).get<std::int64_t>()},
                    film.at("opaque").get<bool>()};
    const auto& [number, whole, time, opaque] = frame;
    constexpr std::int64_t kMost = 1'000'000'000;
    const auto within = [](std::int64_t value, std::int64_t min) { return value >= min && value <= kMost; };
    if (!within(whole.first, 0) || !within(whole.last, whole.first) || !within(whole.step, 1) || !within(number, whole.first) ||
        !within(time.numerator, 1) || !within(time.denominator, 1))
        throw std::out_of_range("film");
    if (whole.count() > kMostPlaces) throw std::out_of_range("film");
    return frame;
}

/// Throws an exception of the JSON library, or std::out_of_range, for what is no picture's report.
ReportedPicture picture_of(const Json& report, const std::string& report_path) {
    ReportedPicture picture;
    PictureFile& file = picture.file;
    file.output = report.at("output").get<std::string>();
    picture.epoch = report.at("pixel_epoch").get<std::int64_t>();
    if (report.contains("shard")) file.shard = Shard{report["shard"].at(0).get<std::int64_t>(), report["shard"].at(1).get<std::int64_t>()};
    if (file.shard && (file.shard->count < 1 || file.shard->count > kMostShards)) throw std::out_of_range("shard");
    if (report.contains("frame")) file.frame = frame_of(report);
    if (report.contains("place"))
        file.place = ScenePlace{report["place"].at("index").get<std::size_t>(), report["place"].at("scenes").get<std::size_t>()};
    if (file.place && (file.place->scenes > kMostPlaces || file.place->index >= file.place->scenes)) throw std::out_of_range("place");
    if (report.contains("scene")) picture.scene = report["scene"].get<std::string>();
    if (report.contains("part_of")) file.part_of = region_of(report["part_of"]);
    if (report.contains("file_hash")) file.file_hash = std::stoull(report["file_hash"].get<std::string>(), nullptr, 16);
    if (report.contains("pixel_hash")) {
        picture.pixel_hash = report["pixel_hash"].get<std::string>();
        picture.size = {report.at("size").at(0).get<int>(), report.at("size").at(1).get<int>()};
        picture.region = region_of(report.at("region"));
    }
    picture.path = file.output;
    const std::string beside = path_in(io::folder_of(report_path), file.output.substr(file.output.rfind('/') + 1));
    if (!is_file(picture.path) && is_file(beside)) picture.path = beside;
    return picture;
}

using Found = std::map<std::string, ReportedPicture>;  // by their outputs

/// Adds what one object of a report tells.
void add_object(const Json& object, const std::string& path, Found& found, std::vector<std::string>& failures) {
    if (!object.at("schema").get<std::string>().starts_with("halflit.report/")) throw std::out_of_range("schema");
    if (object.at("status") == "error") {
        failures.push_back(path + ": " + object.at("error").at("message").get<std::string>());
        return;
    }
    ReportedPicture picture = picture_of(object, path);
    const auto [there, is_new] = found.try_emplace(picture.file.output, picture);
    if (!is_new && picture.file.file_hash != 0) there->second = std::move(picture);
}

Result<void> read_report(const std::string& path, Found& found, std::vector<std::string>& failures) {
    const auto bytes = io::read_file(path, kMostReportBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    std::size_t line = 0;
    try {
        if (const Json whole = Json::parse(text, nullptr, false); whole.is_object()) {
            add_object(whole, path, found, failures);
            return {};
        }
        while (!text.empty()) {
            ++line;
            const std::size_t end = std::min(text.find('\n'), text.size());
            add_object(Json::parse(text.substr(0, end)), path, found, failures);
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    } catch (const std::exception&) {  // of the JSON library; std::out_of_range; std::invalid_argument
        return fail(ErrorCode::bad_input, fmt::format("{}: expected a report of halflit render, found something else{}", path,
                                                      line > 0 ? fmt::format(" in line {}", line) : ""));
    }
    return {};
}

ReportedRun::Kind kind_of(const PictureFile& file) {
    return file.part_of ? ReportedRun::Kind::parts : file.frame ? ReportedRun::Kind::film : ReportedRun::Kind::scenes;
}

/// Where a picture stands in its run.
std::int64_t place_of(const PictureFile& file, const Region& region) {
    if (file.part_of) return region.y;
    if (file.frame) return file.frame->number;
    return file.place ? static_cast<std::int64_t>(file.place->index) : 0;
}

bool same_region(const Region& a, const Region& b) { return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height; }

/// Both are of one run.
bool belong_together(const ReportedPicture& a, const ReportedPicture& b) {
    const PictureFile &one = a.file, &other = b.file;
    if (kind_of(one) != kind_of(other) || a.epoch != b.epoch) return false;
    const bool one_scene = one.part_of || one.frame;
    if (one_scene && !a.scene.empty() && !b.scene.empty() && a.scene != b.scene) return false;
    if (one_scene && a.size.width > 0 && b.size.width > 0 && (a.size.width != b.size.width || a.size.height != b.size.height)) return false;
    if (one.part_of) return same_region(*one.part_of, *other.part_of);
    if (one.frame) {
        const FrameRange &p = one.frame->whole, &q = other.frame->whole;
        return p.first == q.first && p.last == q.last && p.step == q.step && one.frame->time == other.frame->time;
    }
    return one.place.value_or(ScenePlace{}).scenes == other.place.value_or(ScenePlace{}).scenes;
}

/// "3, 5, 8 and 12 more": at most ten.
std::string first_of(const std::set<std::int64_t>& numbers) {
    constexpr std::size_t kShown = 10;
    std::string text;
    std::size_t shown = 0;
    for (const std::int64_t number : numbers) {
        if (shown == kShown) return text + fmt::format(" and {} more", numbers.size() - kShown);
        text += fmt::format("{}{}", shown++ > 0 ? ", " : "", number);
    }
    return text;
}

}  // namespace

Result<ReportedRun> read_reports(const std::vector<std::string>& paths) {
    ReportedRun run;
    Found found;
    for (const std::string& path : paths)
        if (const auto read = read_report(path, found, run.failures); !read) return tl::unexpected(read.error());
    for (auto& [output, picture] : found) run.pictures.push_back(std::move(picture));
    if (run.pictures.empty()) return run;
    for (const ReportedPicture& picture : run.pictures)
        if (!belong_together(run.pictures[0], picture))
            return fail(ErrorCode::usage, fmt::format("expected reports of one run, found {} and {}, which are of two",
                                                      run.pictures[0].file.output, picture.file.output));
    std::stable_sort(run.pictures.begin(), run.pictures.end(), [](const ReportedPicture& a, const ReportedPicture& b) {
        return place_of(a.file, a.region) < place_of(b.file, b.region);
    });
    run.kind = kind_of(run.pictures[0].file);
    for (std::size_t i = 1; i < run.pictures.size(); ++i) {
        const ReportedPicture &before = run.pictures[i - 1], &picture = run.pictures[i];
        if (place_of(before.file, before.region) == place_of(picture.file, picture.region))
            return fail(ErrorCode::usage, fmt::format("expected reports of one run, found {} and {}, which have the same place in it",
                                                      before.file.output, picture.file.output));
    }
    return run;
}

std::string missing_of(const ReportedRun& run) {
    const PictureFile& any = run.pictures[0].file;
    if (run.kind == ReportedRun::Kind::parts) {
        int y = any.part_of->y;
        for (const ReportedPicture& part : run.pictures) {
            if (part.region.y != y || part.region.x != any.part_of->x || part.region.width != any.part_of->width)
                return fmt::format("missing: rows from {} to {}", y, std::max(y, part.region.y - 1));
            y += part.region.height;
        }
        const int end = any.part_of->y + any.part_of->height;
        return y == end ? "" : fmt::format("missing: rows from {} to {}", y, end - 1);
    }
    const bool film = run.kind == ReportedRun::Kind::film;
    const FrameRange whole =
        film ? any.frame->whole : FrameRange{0, static_cast<std::int64_t>(any.place.value_or(ScenePlace{}).scenes) - 1, 1};
    std::set<std::int64_t> there, missing, shards;
    for (const ReportedPicture& picture : run.pictures) there.insert(place_of(picture.file, picture.region));
    for (std::size_t i = 0; i < whole.count(); ++i) {
        if (there.contains(whole.number(i))) continue;
        missing.insert(whole.number(i));
        if (any.shard) shards.insert(static_cast<std::int64_t>(i) % any.shard->count);
    }
    if (missing.empty()) return "";
    std::string text = fmt::format("missing: {} {}", film ? "frames" : "scenes", first_of(missing));
    if (any.shard) text += fmt::format("; of shard{} {} of {}", shards.size() == 1 ? "" : "s", first_of(shards), any.shard->count);
    return text;
}

Result<std::vector<std::byte>> read_verified(const ReportedPicture& picture) {
    auto bytes = io::read_file(picture.path, kMostPictureBytes);
    if (!bytes) return bytes;
    const std::uint64_t hash = pixel_hash({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
    if (picture.file.file_hash != 0 && hash != picture.file.file_hash)
        return fail(ErrorCode::negative_result,
                    fmt::format("{}: expected the file with the hash {:016x}, found {:016x}", picture.path, picture.file.file_hash, hash));
    return bytes;
}

}  // namespace halflit::cli
