// SOG, version 2: a ZIP file of meta.json and of pictures that hold a number of a 3D Gaussian in each pixel.
#include "apps/io/files/load_failure.hpp"
#include "apps/io/files/zip_file.hpp"
#include "apps/io/gltf/text/json_scan.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/splat_reader.hpp"
#include "apps/io/pictures/image_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace halflit::io::detail {
namespace {

/// Numbers and texts of meta.json, by the keys that lead to them: "means/mins".
class SogMeta final : public JsonVisitor {
public:
    std::map<std::string, std::vector<double>> numbers;
    std::map<std::string, std::vector<std::string>> texts;

    explicit SogMeta(Document& document) : document_(document) {}
    void on_key(const JsonValue& key) override { path_.back() = key.text; }
    void on_begin(JsonType, std::size_t) override { path_.emplace_back(); }
    void on_end(std::size_t) override { path_.pop_back(); }
    void on_value(const JsonValue& value, std::size_t) override {
        std::string path;
        for (const std::string& key : path_) path.append(path.empty() || key.empty() ? "" : "/").append(key);
        document_.geometry.take(2 * path.size() + value.text.size() + sizeof(double));
        if (value.type == JsonType::string)
            texts[path].emplace_back(value.text);
        else
            numbers[path].push_back(value.type == JsonType::null ? std::numeric_limits<double>::quiet_NaN() : value.number);
    }
    void on_twin(std::string_view, std::size_t, std::size_t, std::size_t) override {}
    void on_loose(const JsonFault&) override {}

    /// A list of at least so many numbers.
    const std::vector<double>& list(const std::string& path, std::size_t least) {
        const auto& found = numbers[path];
        if (found.size() < least) refuse("meta.json", fmt::format("{}: expected {} numbers, found {}", path, least, found.size()));
        return found;
    }
    /// Values of 256 codes. Some writers left the first one out, which goes on as the others do.
    std::array<double, 256> book(const std::string& path) {
        std::array<double, 256> values{};
        const auto& found = list(path, 1);
        std::copy_n(found.begin(), std::min<std::size_t>(found.size(), 256), values.begin());
        if (std::isnan(values[0])) values[0] = values[1] + (values[1] - values[255]) / 255.0;
        return values;
    }

private:
    Document& document_;
    std::vector<std::string> path_;
};

class SogReader {
public:
    SogReader(const ModelFile& file, Document& document) : document_(document), zip_(file.bytes), meta_(document) {}

    /// Nothing: meta.json is of something else.
    std::optional<SplatCloud> read() {
        constexpr std::string_view kMeta = "meta.json";
        const auto found = std::find_if(zip_.entries().begin(), zip_.entries().end(),
                                        [&](const ZipFile::Entry& entry) { return entry.name.ends_with(kMeta); });
        if (found == zip_.entries().end()) return std::nullopt;
        folder_ = found->name.substr(0, found->name.size() - kMeta.size());
        const std::vector<std::byte> text = unpacked(*found);
        try {
            scan_json(as_text(text), {document_.options.limits.max_json_depth, document_.options.limits.max_json_tokens}, meta_);
        } catch (const JsonFault& fault) {
            refuse(kMeta, fault.what, fault.code);
        }
        if (meta_.texts["means/files"].empty()) return std::nullopt;
        if (const auto& version = meta_.numbers["version"]; version.empty() || version[0] != 2.0)
            refuse(kMeta, fmt::format("expected version 2, found {}", version.empty() ? 1.0 : version[0]));
        const double all = meta_.list("count", 1)[0];
        if (!(all >= 0.0 && all < 4294967296.0)) refuse(kMeta, "count: expected a number of Gaussians");
        count_ = static_cast<std::size_t>(all);
        return read_cloud();
    }

private:
    std::vector<std::byte> unpacked(const ZipFile::Entry& entry) {
        zip_.check_size(entry);
        document_.geometry.take(entry.bytes);
        std::vector<std::byte> bytes(entry.bytes);
        zip_.unpack(entry, bytes);
        check_time();
        return bytes;
    }

    /// The picture number `number` of a list of files, of at least `pixels`.
    DecodedImage picture(const char* list, std::size_t number, std::size_t pixels) {
        const auto& names = meta_.texts[fmt::format("{}/files", list)];
        if (names.size() <= number) refuse("meta.json", fmt::format("{}: expected {} files", list, number + 1));
        const std::string name = folder_ + names[number];
        const ZipFile::Entry* const entry = zip_.find(name);
        if (entry == nullptr) refuse(printable(name, 80), "is not in the file");
        const LoadLimits& most = document_.options.limits;
        const ImageLimits limits{.max_side = most.max_texture_side, .max_pixels = most.max_texture_pixels};
        const std::vector<std::byte> bytes = unpacked(*entry);
        const ImageHeader header = take(read_image_header(bytes, limits), printable(name, 80));
        const std::uint64_t size = static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
        if (size < pixels) refuse(printable(name, 80), fmt::format("has {} pixels, expected {}", size, pixels));
        document_.geometry.take(4 * size);
        return take(decode_image(bytes, limits), printable(name, 80));
    }

    SplatCloud read_cloud() {
        const DecodedImage low = picture("means", 0, count_), high = picture("means", 1, count_), quats = picture("quats", 0, count_),
                           scales = picture("scales", 0, count_), sh0 = picture("sh0", 0, count_);
        const auto &least = meta_.list("means/mins", 3), &most = meta_.list("means/maxs", 3);
        const auto sizes = meta_.book("scales/codebook"), colors = meta_.book("sh0/codebook");
        // A palette of the further coefficients has 64 entries a row, each of as many pixels as there are coefficients.
        DecodedImage palette, labels;
        std::array<double, 256> rests{};
        if (!meta_.texts["shN/files"].empty()) {
            palette = picture("shN", 0, 1), labels = picture("shN", 1, count_), rests = meta_.book("shN/codebook");
            if (palette.width % 64 != 0 || rest_of_degree(degree_of(rest_of(palette))) != rest_of(palette))
                refuse("meta.json", fmt::format("shN: a palette {} pixels wide is of no degree", palette.width));
        }
        const std::size_t rest = rest_of(palette);
        SplatCloud cloud;
        cloud.axes = kRightDownFront;
        cloud.reserve(document_, count_, degree_of(rest));
        if (const auto& model = meta_.texts["model"]; !model.empty()) cloud.set_reference(model[0], document_);
        for (std::size_t i = 0; i < count_; ++i) {
            if (i % 4096 == 0) check_time();
            std::array<double, 3> position{}, others{}, scale{};
            for (std::size_t c = 0, at = 4 * i; c < 3; ++c, ++at) {
                const double log = between(least[c], most[c], low.rgba8[at] | static_cast<std::uint32_t>(high.rgba8[at]) << 8, 65535);
                position[c] = log == log ? std::copysign(scale_of_log(std::fabs(log)) - 1.0, log) : log;
                others[c] = between(-0.70710678118654752, 0.70710678118654752, quats.rgba8[at], 255);
                scale[c] = scale_of_log(sizes[scales.rgba8[at]]);
            }
            const std::uint8_t largest = quats.rgba8[4 * i + 3];
            cloud.add(position, largest < 252 ? std::array<double, 4>{} : rotation_of(others, largest - 252u, true), scale,
                      sh0.rgba8[4 * i + 3] / 255.0);
            for (std::size_t c = 0; c < 3; ++c) cloud.add_color(colors[sh0.rgba8[4 * i + c]]);
            const std::size_t label = rest == 0 ? 0 : labels.rgba8[4 * i] | static_cast<std::size_t>(labels.rgba8[4 * i + 1]) << 8;
            for (std::size_t k = 0; k < rest; ++k)
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = 4 * (label * rest + k) + c;
                    cloud.add_color(at < palette.rgba8.size() ? rests[palette.rgba8[at]] : 0.0);
                }
        }
        return cloud;
    }

    static std::size_t rest_of(const DecodedImage& palette) { return static_cast<std::size_t>(palette.width) / 64; }

    Document& document_;
    ZipFile zip_;
    SogMeta meta_;
    std::string folder_;
    std::size_t count_ = 0;
};

}  // namespace

std::optional<LoadedScene> read_sog_file(const ModelFile& file, const LoadOptions& options) {
    ModelBuilder builder(file.bytes, file.folder, options, "SOG");
    auto cloud = SogReader(file, builder.document()).read();
    if (!cloud) return std::nullopt;
    return finish_splats(builder, *std::move(cloud));
}

}  // namespace halflit::io::detail
