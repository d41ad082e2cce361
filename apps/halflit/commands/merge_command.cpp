// halflit merge: verifies what shards have drawn by their reports, and joins it.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/hash_text.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/farm/shard.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/pictures/float_image.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "halflit/image.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <set>
#include <tuple>

namespace halflit::cli {
namespace {

constexpr std::size_t kMostReportBytes = std::size_t{1} << 30, kMostPictureBytes = std::size_t{4} << 30;
constexpr std::int64_t kMostPlaces = 10'000'000;  ///< frames, scenes or rows of a run
constexpr std::size_t kShown = 10;                ///< places, or lines, in messages

struct MergeOptions {
    std::vector<std::string> reports;
    std::string output;  ///< empty: verify alone
    bool dither = false;
};

/// A picture that a report names. Its run is divided by scenes, frames or rows, which have numbers.
struct ReportedPicture {
    std::string output, path;  ///< its name in the report; where it is: there, or in the report's folder
    std::string file_hash;     ///< empty: not known, since the file was there already (--skip-existing)
    std::string unit = "scenes";
    FrameRange places, whole;  ///< numbers of this picture, and of the run
    std::optional<Shard> shard;
    Json same;         ///< what all reports of the run have in common
    PictureSize size;  ///< rows: of the joined picture
    film::FrameTime time;
    bool opaque = true;  ///< no pixel of any frame is transparent
};

std::int64_t number(const Json& json, std::int64_t min = 0, std::int64_t max = 1'000'000'000) {
    const auto value = json.get<std::int64_t>();
    if (value < min || value > max) throw std::out_of_range("number");
    return value;
}

/// The rows of [x, y, width, height].
FrameRange row_range(const Json& region) { return {number(region.at(1)), number(region.at(1)) + number(region.at(3), 1) - 1, 1}; }

/// Throws an exception of the JSON library, or std::out_of_range, for what is no picture's report.
ReportedPicture picture_of(const Json& report, const std::string& report_path) {
    ReportedPicture picture;
    picture.output = report.at("output").get<std::string>();
    const std::string beside = path_in(io::folder_of(report_path), picture.output.substr(picture.output.rfind('/') + 1));
    picture.path = !is_file(picture.output) && is_file(beside) ? beside : picture.output;
    picture.file_hash = report.value("file_hash", "");
    const auto given = [&](const char* key) { return report.contains(key) ? report[key] : Json(); };
    if (const Json shard = given("shard"); !shard.is_null())
        picture.shard = Shard{number(shard.at(0)), number(shard.at(1), 1, kMostShards)};
    for (const char* const key : {"pixel_epoch", "film", "part_of"}) picture.same[key] = given(key);
    if (const Json part_of = given("part_of"); !part_of.is_null()) {
        picture.unit = "rows";
        picture.places = row_range(report.at("region"));
        picture.whole = row_range(part_of);
        picture.size = {static_cast<int>(number(part_of.at(2), 1)), static_cast<int>(number(part_of.at(3), 1))};
        picture.same["shards"] = report.at("shard").at(1);
    } else if (const Json film = given("film"); !film.is_null()) {
        picture.unit = "frames";
        picture.places.first = picture.places.last = number(report.at("frame"));
        picture.whole = {number(film.at("first")), number(film.at("last")), number(film.at("step"), 1)};
        picture.time = {number(film.at("seconds_each").at(0), 1), number(film.at("seconds_each").at(1), 1)};
        picture.opaque = film.at("opaque").get<bool>();
    } else if (const Json place = given("place"); !place.is_null()) {
        picture.places.first = picture.places.last = number(place.at("index"));
        picture.whole.last = number(place.at("scenes"), 1) - 1;
    }
    const auto& [places, whole] = std::tie(picture.places, picture.whole);
    if (places.first < whole.first || places.last > whole.last || whole.last - whole.first >= kMostPlaces) throw std::out_of_range("place");
    for (const char* const key : {"scene", "size"})  // a picture that was there already has no size
        if (picture.unit != "scenes" && report.contains(key)) picture.same[key] = report[key];
    return picture;
}

bool of_one_run(const ReportedPicture& a, const ReportedPicture& b) {
    const auto agrees = [&](const auto& entry) { return !b.same.contains(entry.key()) || b.same[entry.key()] == entry.value(); };
    const auto entries = a.same.items();
    return a.unit == b.unit && a.whole.last == b.whole.last && std::all_of(entries.begin(), entries.end(), agrees);
}

/// Reads a JSON object or JSON lines.
Result<void> read_report(const std::string& path, std::vector<ReportedPicture>& pictures, std::vector<std::string>& failures) {
    const auto bytes = io::read_file(path, kMostReportBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const auto add = [&](const Json& report) {
        if (!report.at("schema").get<std::string>().starts_with("halflit.report/")) throw std::out_of_range("schema");
        if (report.at("status") == "error")
            failures.push_back(path + ": " + report.at("error").at("message").get<std::string>());
        else
            pictures.push_back(picture_of(report, path));
    };
    std::size_t line = 0;
    try {
        const Json whole = Json::parse(text, nullptr, false);
        if (whole.is_object()) add(whole);
        for (std::size_t at = whole.is_object() ? text.size() : 0, end = 0; at < text.size(); at = end + 1) {
            ++line, end = std::min(text.find('\n', at), text.size());
            add(Json::parse(text.substr(at, end - at)));
        }
    } catch (const std::exception&) {  // of the JSON library; std::out_of_range
        return fail(ErrorCode::bad_input, fmt::format("{}: expected a report of halflit render, found something else{}", path,
                                                      line > 0 ? fmt::format(" in line {}", line) : ""));
    }
    return {};
}

/// The pictures by their places. An output that is named twice counts once; where it was drawn, before where it was there already. Fails
/// (usage) for pictures of two runs, or of one place.
Result<std::vector<ReportedPicture>> read_reports(const std::vector<std::string>& paths, std::vector<std::string>& failures) {
    std::vector<ReportedPicture> pictures;
    for (const std::string& path : paths)
        if (const auto read = read_report(path, pictures, failures); !read) return tl::unexpected(read.error());
    const auto rank = [](const ReportedPicture& picture) {
        return std::tuple(picture.places.first, picture.output, picture.file_hash.empty());
    };
    std::stable_sort(pictures.begin(), pictures.end(),
                     [&](const ReportedPicture& a, const ReportedPicture& b) { return rank(a) < rank(b); });
    const auto same_output = [](const ReportedPicture& a, const ReportedPicture& b) { return a.output == b.output; };
    pictures.erase(std::unique(pictures.begin(), pictures.end(), same_output), pictures.end());
    for (std::size_t i = 1; i < pictures.size(); ++i) {
        const bool one_run = of_one_run(pictures[0], pictures[i]);
        if (!one_run || pictures[i - 1].places.last >= pictures[i].places.first)
            return fail(ErrorCode::usage,
                        fmt::format("expected reports of one run, found {} and {}, which {}", pictures[one_run ? i - 1 : 0].output,
                                    pictures[i].output, one_run ? "have the same place in it" : "are of two"));
    }
    return pictures;
}

/// "3, 5, 8 and 12 more"
std::string first_of(const std::set<std::int64_t>& numbers) {
    const auto end = std::next(numbers.begin(), static_cast<std::ptrdiff_t>(std::min(numbers.size(), kShown)));
    const std::string text = fmt::format("{}", fmt::join(numbers.begin(), end, ", "));
    return numbers.size() <= kShown ? text : text + fmt::format(" and {} more", numbers.size() - kShown);
}

/// The pictures that the run lacks: nothing, or one line that names the first places and the shards that draw them.
std::string missing_of(const std::vector<ReportedPicture>& pictures) {
    const auto& [unit, whole, shard] = std::tie(pictures[0].unit, pictures[0].whole, pictures[0].shard);
    const auto all = static_cast<std::int64_t>(whole.count());
    std::set<std::int64_t> missing, shards;
    auto next = pictures.begin();
    for (std::int64_t i = 0; i < all; ++i) {
        const std::int64_t place = whole.number(static_cast<std::size_t>(i));
        while (next != pictures.end() && next->places.last < place) ++next;
        if (next != pictures.end() && next->places.first <= place) continue;
        missing.insert(place);
        if (shard) shards.insert(unit == "rows" ? ((i + 1) * shard->count - 1) / all : i % shard->count);
    }
    if (missing.empty()) return "";
    const std::string of = shard ? fmt::format("; of shard{} {} of {}", shards.size() == 1 ? "" : "s", first_of(shards), shard->count) : "";
    return fmt::format("missing: {} {}{}", unit, first_of(missing), of);
}

/// The picture that was drawn; floats in rgba_linear, opaque.
Result<Image> decode(const std::string& path, std::span<const std::byte> bytes) {
    constexpr int kAnySide = std::numeric_limits<int>::max();
    constexpr auto kMostPixels = static_cast<std::size_t>(kMaxImagePixels);
    if (!io::is_float_image(bytes)) return io::decode_picture(bytes, path, {kAnySide, kMostPixels});
    const auto floats = io::decode_float_image(bytes, {kAnySide, kAnySide, kMostPixels});
    if (!floats) return tl::unexpected(floats.error());
    Image image{floats->width, floats->height, {}, {}};
    for (std::size_t i = 0; i < floats->rgb.size(); i += 3)
        image.rgba_linear.insert(image.rgba_linear.end(), {floats->rgb[i], floats->rgb[i + 1], floats->rgb[i + 2], 1.0f});
    return image;
}

/// Puts bands of rows one below the other.
class RowWriter : public film::FilmWriter {
public:
    RowWriter(PictureSize size, OutputFormat format) : joined_{size.width, size.height, {}, {}}, format_(format) {}
    Result<void> add(const Image& band) override {
        if (is_linear(format_) != band.rgba8.empty())
            return fail(ErrorCode::usage, band.rgba8.empty() ? "has floats: expected a file of floats as the output"
                                                             : "has 8-bit codes: expected a file of 8-bit codes as the output");
        joined_.rgba8.insert(joined_.rgba8.end(), band.rgba8.begin(), band.rgba8.end());
        joined_.rgba_linear.insert(joined_.rgba_linear.end(), band.rgba_linear.begin(), band.rgba_linear.end());
        return {};
    }
    Result<std::vector<std::uint8_t>> finish() override {
        if (joined_.rgba8.size() + joined_.rgba_linear.size() !=
            std::size_t{4} * static_cast<std::size_t>(joined_.width) * static_cast<std::size_t>(joined_.height))
            return fail(ErrorCode::negative_result, fmt::format("the parts are not {}x{} pixels", joined_.width, joined_.height));
        if (!joined_.rgba8.empty()) std::printf("pixel_hash %s\n", hash_text(joined_.rgba8).c_str());
        return encode_image(joined_, format_);
    }

private:
    Image joined_;
    OutputFormat format_;
};

/// Makes the writer of the output, which takes the pictures in order. `first` is the first of them.
Result<std::unique_ptr<film::FilmWriter>> make_writer(const std::vector<ReportedPicture>& pictures, const Image& first,
                                                      const MergeOptions& options) {
    const auto& [output, any] = std::tie(options.output, pictures[0]);
    if (any.unit == "rows") {
        const auto format = output_format_of(output);
        if (!format) return tl::unexpected(format.error());
        return std::make_unique<RowWriter>(any.size, *format);
    }
    const auto format = film::film_format_of(output);
    if (any.unit == "scenes" || !format)
        return fail(ErrorCode::usage, "-o " + output +
                                          ": expected reports of one picture's parts, or of frames and a .gif, .apng or .webp "
                                          "file; pictures of many scenes are only verified");
    return film::make_film_writer(*format, {first.width, first.height, pictures.size(), any.time, any.opaque, options.dither});
}

/// Compares each picture with its hash, and joins them if there is an output.
Result<void> read_pictures(const std::vector<ReportedPicture>& pictures, const MergeOptions& options) {
    std::unique_ptr<film::FilmWriter> writer;
    PictureSize size;
    for (const ReportedPicture& picture : pictures) {
        const auto& [path, hash, unit] = std::tie(picture.path, picture.file_hash, picture.unit);
        const auto bytes = io::read_file(path, kMostPictureBytes);
        if (!bytes) return tl::unexpected(bytes.error());
        if (const std::string found = hash_text({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
            !hash.empty() && hash != found)
            return fail(ErrorCode::negative_result, fmt::format("{}: expected the file with the hash {}, found {}", path, hash, found));
        if (options.output.empty()) continue;
        const auto image = decode(path, *bytes);
        if (!image) return fail(image.error().code, path + ": " + image.error().message);
        if (!writer) {
            auto made = make_writer(pictures, *image, options);
            if (!made) return tl::unexpected(made.error());
            writer = std::move(*made), size = {image->width, image->height};
        }
        if (unit == "frames" && (image->width != size.width || image->height != size.height || image->rgba8.empty()))
            return fail(ErrorCode::negative_result, fmt::format("{}: expected {}x{} pixels of 8-bit codes", path, size.width, size.height));
        if (const auto added = writer->add(*image); !added) return fail(added.error().code, path + ": " + added.error().message);
    }
    if (!writer) return {};
    const auto file = writer->finish();
    if (!file) return tl::unexpected(file.error());
    return io::write_file(options.output, *file);
}

Result<int> run_merge(const MergeOptions& options) {
    const std::string& output = options.output;
    if (output == "-") return fail(ErrorCode::usage, "-o: expected a file name, found -");
    if (const auto checked = output.empty() ? Result<void>() : check_writable(output); !checked) return tl::unexpected(checked.error());
    std::vector<std::string> failures;
    const auto pictures = read_reports(options.reports, failures);
    if (!pictures) return tl::unexpected(pictures.error());
    const std::string missing = pictures->empty() ? "the reports name no picture" : missing_of(*pictures);
    if (!missing.empty()) failures.insert(failures.begin(), missing);
    for (const ReportedPicture& picture : *pictures) {
        if (!output.empty() && same_file(output, picture.path))
            return fail(ErrorCode::io, output + ": is read for the output and is not overwritten");
        if (!is_there(picture.path)) failures.push_back(picture.path + " is not there");
    }
    for (std::size_t i = 0; i < std::min(failures.size(), kShown); ++i) print_error(failures[i]);
    if (failures.size() > kShown) print_error(fmt::format("and {} more", failures.size() - kShown));
    if (!failures.empty()) return static_cast<int>(ErrorCode::negative_result);
    if (const auto done = read_pictures(*pictures, options); !done) return tl::unexpected(done.error());
    const auto unknown =
        std::count_if(pictures->begin(), pictures->end(), [](const ReportedPicture& picture) { return picture.file_hash.empty(); });
    if (unknown > 0)
        print_warning(
            fmt::format("{} of {} pictures were there before their run, so their hashes are not known", unknown, pictures->size()));
    print_note(fmt::format("{0}{1} of {1} are complete{2}", output.empty() ? "" : "wrote " + output + ": ", pictures->size(),
                           unknown == 0 ? " and have the hashes of their reports" : ""));
    return 0;
}

}  // namespace

Command merge_command() {
    const auto options = std::make_shared<MergeOptions>();
    MergeOptions& o = *options;
    Positional reports{.name = "REPORT",
                       .help = "Reports of halflit render --shard I/N --report FILE",
                       .read = append_to(o.reports),
                       .required = true,
                       .repeated = true,
                       .form = "FILE",
                       .usage = "REPORT..."};
    return {"merge",
            "Check by their reports that the pictures of all shards are complete, and join parts or frames; exit code 1 if they are not",
            {std::move(reports)},
            {{"Flags",
              {{"-o,--output", "FILE", "Join parts into a picture, or frames into one .gif, .apng or .webp file; without it, verify alone",
                read_text(o.output)},
               {"--dither", "", "GIF: mix its 256 colours by an ordered pattern", set_to(o.dither)}}}},
            [options] { return run_merge(*options); }};
}

}  // namespace halflit::cli
