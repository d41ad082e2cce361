#include "apps/io/models/slicer_project.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/text/json_scan.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/xml_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kMostFilaments = 255;

/// Filaments are drawn opaque.
std::optional<Vec4f> color_of_text(std::string_view text) {
    std::optional<Vec4f> color = three_mf::parse_color(text);
    if (color) color->w = 1.0f;
    return color;
}

std::uint32_t number(std::string_view text) { return parse_whole<std::uint32_t>(Words(text).rest()).value_or(kNone); }

int filament(std::string_view text) {
    const std::uint32_t value = number(text);
    return value <= kMostFilaments ? static_cast<int>(value) : 0;
}

/// True for the kinds of volumes that are not printed, by the names of all slicers.
bool is_helper(std::string_view kind) {
    static constexpr std::string_view kHelpers[] = {"modifier_part",  "negative_part",     "support_blocker", "support_enforcer",
                                                    "NegativeVolume", "ParameterModifier", "SupportBlocker",  "SupportEnforcer"};
    return std::find(std::begin(kHelpers), std::end(kHelpers), kind) != std::end(kHelpers);
}

/// model_settings.config and Slic3r_PE_model.config.
class VolumeReader : public XmlSink {
public:
    VolumeReader(SlicerProject& project, Document& document) : project_(project), document_(document) {}

    void begin(const XmlName& element, const XmlAttributes& attributes, std::size_t) override {
        const std::string_view name = element.local;
        document_.geometry.take(64);
        if (name == "object") {
            object_ = number(attributes.get("id"));
        } else if (name == "part") {
            volume_ = &project_.parts[{object_, number(attributes.get("id"))}];
            volume_->is_drawn = !is_helper(attributes.get("subtype"));
        } else if (name == "volume") {
            auto& runs = project_.runs[object_];
            runs.push_back({number(attributes.get("firstid")), number(attributes.get("lastid")), {}});
            volume_ = &runs.back().volume;
        } else if (name == "plate") {
            plate_ = static_cast<int>(project_.plates.size()) + 1;
        } else if (name == "model_instance") {
            placed_ = {};
        } else if (name == "metadata") {
            begin_metadata(attributes.get("key"), attributes.get("value"));
        }
    }
    void end(std::string_view name) override {
        if (name == "object") object_ = kNone;
        if (name == "part" || name == "volume") volume_ = nullptr;
        if (name == "model_instance" && plate_ > 0) project_.plates[plate_].push_back(placed_);
        if (name == "plate") plate_ = 0;
    }

private:
    void begin_metadata(std::string_view key, std::string_view value) {
        if (key == "extruder" && volume_ != nullptr)
            volume_->filament = filament(value);
        else if (key == "extruder" && object_ != kNone)
            project_.objects[object_] = filament(value);
        else if (volume_ != nullptr && ((key == "modifier" && value == "1") || (key == "volume_type" && is_helper(value))))
            volume_->is_drawn = false;
        else if (plate_ > 0 && key == "plater_id" && number(value) > 0 && number(value) <= kMostFilaments)
            plate_ = static_cast<int>(number(value));
        else if (plate_ > 0 && key == "object_id")
            placed_.object = number(value);
        else if (plate_ > 0 && key == "instance_id")
            placed_.instance = number(value);
    }

    SlicerProject& project_;
    Document& document_;
    std::uint32_t object_ = kNone;
    SlicerProject::Volume* volume_ = nullptr;
    int plate_ = 0;
    SlicerProject::Placed placed_;
};

/// The list "filament_colour" of project_settings.config.
class FilamentReader final : public JsonVisitor {
public:
    explicit FilamentReader(std::vector<Vec4f>& filaments) : filaments_(filaments) {}
    void on_key(const JsonValue& key) override { named_ = depth_ == 1 && key.text == "filament_colour"; }
    void on_begin(JsonType, std::size_t) override { ++depth_; }
    void on_end(std::size_t) override {
        if (--depth_ == 1) named_ = false;
    }
    void on_value(const JsonValue& value, std::size_t) override {
        if (named_ && depth_ == 2 && value.type == JsonType::string && filaments_.size() < kMostFilaments)
            filaments_.push_back(color_of_text(value.text).value_or(Vec4f{1, 1, 1, 1}));
    }
    void on_twin(std::string_view, std::size_t, std::size_t, std::size_t) override {}

private:
    std::vector<Vec4f>& filaments_;
    int depth_ = 0;
    bool named_ = false;
};

/// Reads Slic3r_PE.config: "; extruder_colour = #FF8000;#DB5182", whose empty entries are those of "filament_colour".
void read_prusa_colors(std::string_view text, std::vector<Vec4f>& filaments) {
    std::vector<std::string_view> of_extruder, of_filament;
    Lines lines(text);
    for (std::string_view line; lines.next(line);) {
        Words words(line);
        if (words.next() != ";") continue;
        const std::string_view key = words.next();
        if ((key != "extruder_colour" && key != "filament_colour") || words.next() != "=") continue;
        std::string_view list = words.rest();
        auto& colors = key == "extruder_colour" ? of_extruder : of_filament;
        while (!list.empty() && colors.size() < kMostFilaments) {
            const std::string_view one = list.substr(0, list.find(';'));
            list.remove_prefix(std::min(list.size(), one.size() + 1));
            colors.push_back(one);
        }
    }
    for (std::size_t i = 0; i < std::max(of_extruder.size(), of_filament.size()); ++i) {
        std::optional<Vec4f> color;
        if (i < of_extruder.size()) color = color_of_text(of_extruder[i]);
        if (!color && i < of_filament.size()) color = color_of_text(of_filament[i]);
        filaments.push_back(color.value_or(Vec4f{1, 1, 1, 1}));
    }
}

/// The next number of a paint's tree, from its end.
std::optional<unsigned> next_digit(std::string_view& paint) {
    if (paint.empty()) return std::nullopt;
    unsigned digit = 0;
    const auto [end, error] = std::from_chars(&paint.back(), &paint.back() + 1, digit, 16);
    if (error != std::errc()) return std::nullopt;
    paint.remove_suffix(1);
    return digit;
}

struct Painter {
    std::string_view paint;
    std::vector<Vec3d>& vertices;
    std::vector<PaintedTriangle>& out;

    std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
        vertices.push_back((vertices[a] + vertices[b]) * 0.5);
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }

    /// Goes past so many parts, with all that they are divided into.
    void pass_over(std::uint64_t parts) {
        TimeCheck check;
        for (; parts > 0; --parts) {
            check();
            const std::optional<unsigned> code = next_digit(paint);
            if (!code) return;
            if ((*code & 3u) != 0)
                parts += (*code & 3u) + 1;
            else if (*code >> 2 == 3)
                next_digit(paint);
        }
    }

    void divide(const std::array<std::uint32_t, 3>& facet, int depth) {
        constexpr int kMostDepth = 24;  // sides of 2^-24 of the facet's
        const std::optional<unsigned> code = next_digit(paint);
        const unsigned sides = code.value_or(0) & 3u;
        if (sides > 0 && depth >= kMostDepth) {
            pass_over(sides + 1);
            out.push_back({facet, 0});
            return;
        }
        if (sides == 0) {
            unsigned filament = code.value_or(0) >> 2;
            if (filament == 3) filament += next_digit(paint).value_or(0);
            out.push_back({facet, static_cast<int>(filament)});
            return;
        }
        const unsigned turn = *code >> 2;  // the vertex that the division begins at
        const std::uint32_t a = facet[turn % 3], b = facet[(turn + 1) % 3], c = facet[(turn + 2) % 3];
        std::array<std::array<std::uint32_t, 3>, 4> parts{};
        if (sides == 1) {
            const std::uint32_t bc = middle(b, c);
            parts = {{{a, b, bc}, {bc, c, a}}};
        } else if (sides == 2) {
            const std::uint32_t ab = middle(a, b), ca = middle(c, a);
            parts = {{{a, ab, ca}, {ab, b, ca}, {b, c, ca}}};
        } else {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            parts = {{{a, ab, ca}, {ab, b, bc}, {bc, c, ca}, {ab, bc, ca}}};
        }
        for (unsigned i = sides + 1; i-- > 0;) divide(parts[i], depth + 1);  // the last part comes first
    }
};

}  // namespace

SlicerProject::Volume SlicerProject::volume_of(std::uint32_t object, std::uint32_t part) const {
    const auto found = parts.find({object, part});
    return found == parts.end() ? Volume{} : found->second;
}

int SlicerProject::filament_of(std::uint32_t object, const Volume& volume) const {
    if (volume.filament > 0) return volume.filament;
    const auto found = objects.find(object);
    return found == objects.end() || found->second == 0 ? 1 : found->second;
}

Vec4f SlicerProject::color_of(int number) const {
    static constexpr std::string_view kUsual[] = {"#FF8000", "#DB5182", "#3EC0FF", "#FF4F4F", "#FBEB7D"};
    const auto at = static_cast<std::size_t>(std::max(1, number) - 1);
    return at < filaments.size() ? filaments[at] : *color_of_text(kUsual[at % std::size(kUsual)]);
}

SlicerProject read_slicer_project(ThreeMfPackage& package, Document& document) {
    SlicerProject project;
    const auto read = [&](const std::string& name, const auto& take_in) {
        try {
            if (auto bytes = package.read(name)) take_in(*bytes);
        } catch (const LoadFailure& failure) {
            document.go_on_without(failure, "what it says is left out");
        } catch (const JsonFault& fault) {
            document.go_on_without({{fault.code, fmt::format("{}: {}", name, fault.what)}}, "what it says is left out");
        }
    };
    for (const char* name : {"Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config"})
        read(name, [&](std::vector<std::byte>& bytes) {
            VolumeReader reader(project, document);
            read_xml(bytes, name, document, reader);
        });
    read("Metadata/project_settings.config", [&](const std::vector<std::byte>& bytes) {
        FilamentReader reader(project.filaments);
        scan_json(as_text(bytes), {document.options.limits.max_json_depth, document.options.limits.max_json_tokens}, reader);
    });
    if (project.filaments.empty())
        read("Metadata/Slic3r_PE.config",
             [&](const std::vector<std::byte>& bytes) { read_prusa_colors(as_text(bytes), project.filaments); });
    return project;
}

std::vector<int> plates_by_place(std::span<const DoubleBox> objects) {
    constexpr double kWidths[] = {400, 350, 325, 300, 256, 250, 235, 220, 180};  // millimetres
    std::vector<int> plates(objects.size(), 1);
    const auto is_in_reach = [](const DoubleBox& b) { return b.min.x >= 0 && b.min.x <= b.max.x && b.max.x < 1e5 && b.min.y > -1e5; };
    if (objects.size() < 2 || !std::all_of(objects.begin(), objects.end(), is_in_reach)) return plates;
    for (const double width : kWidths) {
        const double step = 1.2 * width;
        std::map<std::pair<int, int>, int> number;  // of a cell
        std::vector<std::pair<int, int>> cells;
        for (const DoubleBox& object : objects) {
            const double column = std::floor(object.min.x / step), row = std::floor(object.min.y / step);
            if (object.max.x - column * step > width || object.max.y - row * step > width || row > 0 || row < -100) break;
            cells.emplace_back(static_cast<int>(-row), static_cast<int>(column));
            number[cells.back()] = 0;
        }
        if (cells.size() < objects.size()) continue;
        int count = 0;
        for (auto& [where, plate] : number) plate = ++count;
        for (std::size_t i = 0; i < objects.size(); ++i) plates[i] = number[cells[i]];
        return plates;
    }
    return plates;
}

void divide_painted(const std::array<std::uint32_t, 3>& facet, std::string_view paint, std::vector<Vec3d>& vertices,
                    std::vector<PaintedTriangle>& out) {
    Painter{paint, vertices, out}.divide(facet, 0);
}

}  // namespace halflit::io::detail
