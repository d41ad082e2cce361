#include "apps/io/models/three_mf_model.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/xml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>

namespace halflit::io::detail {

namespace {

using namespace three_mf;

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02 ";
constexpr std::string_view kMaterial = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02 ";
constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
/// Named groups of triangles; they say nothing about the picture.
constexpr std::string_view kTriangleSets = "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07";
constexpr const char* kPaintBambu = "paint_color";
constexpr const char* kPaintPrusa = "http://schemas.slic3r.org/3mf/2017/06 mmu_segmentation";
constexpr std::string_view kProductionPath = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06 path";

double metres_of(std::string_view unit) {
    constexpr std::pair<std::string_view, double> kUnits[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                                                              {"inch", 0.0254}, {"foot", 0.3048},     {"meter", 1.0}};
    for (const auto& [name, metres] : kUnits)
        if (name == unit) return metres;
    return 0.0;
}

class ModelReader : public XmlSink {
public:
    ModelReader(std::string where, ModelBuilder& builder) : part_(std::move(where)), builder_(builder) {}

    Model take() { return std::move(model_); }

    void begin(std::string_view name, const XmlAttributes& attributes, std::size_t line) override {
        line_ = line;
        if (name.starts_with(kCore)) return begin_core(name.substr(kCore.size()), attributes);
        if (name.starts_with(kMaterial)) return begin_material(name.substr(kMaterial.size()), attributes);
        warn_of_others(name.substr(0, name.find(' ')));
    }
    void declare(std::string_view prefix, std::string_view name_space) override {
        builder_.document().geometry.take(prefix.size() + name_space.size() + 128);
        name_space_of_[std::string(prefix)] = name_space;
        for (const std::string_view slicer : {"slic3r", "bambulab", "prusa"})
            if (name_space.find(slicer) != std::string_view::npos) model_.is_of_slicer = true;
    }
    void end(std::string_view name) override {
        if (name == std::string(kCore) + "object") object_ = nullptr;
    }

private:
    [[noreturn]] void fault(const std::string& what, ErrorCode code = ErrorCode::bad_input) const {
        refuse(fmt::format("{}: line {}", part_, line_), what, code);
    }

    // ---- attributes ----------------------------------------------------------------------------------------------------
    std::optional<std::uint32_t> whole(const XmlAttributes& attributes, std::string_view name) const {
        const char* text = attributes.find(name);
        if (text == nullptr) return std::nullopt;
        const auto value = parse_whole<std::uint32_t>(Words(text).rest());
        if (!value || *value == kNone) fault(fmt::format("{}: expected a whole number, found \"{}\"", name, printable(text, 40)));
        return value;
    }
    std::uint32_t needed(const XmlAttributes& attributes, std::string_view name) const {
        const auto value = whole(attributes, name);
        if (!value) fault(fmt::format("expected the attribute {}", name));
        return *value;
    }
    template <class T>
    T real(const XmlAttributes& attributes, std::string_view name) const {
        const char* text = attributes.find(name);
        const auto value = parse_real<T>(Words(text == nullptr ? "" : text).rest());  // XML Schema allows white space around it
        if (!value) fault(fmt::format("{}: expected a number, found \"{}\"", name, printable(text == nullptr ? "" : text, 40)));
        return *value;
    }
    /// Twelve numbers: the images of x, y and z, and that of the origin.
    Affine transform(const XmlAttributes& attributes) const {
        const char* text = attributes.find("transform");
        if (text == nullptr) return {};
        Words words(text);
        double m[12];
        for (double& value : m) {
            const auto number = parse_real<double>(words.next());
            if (!number) fault(fmt::format("transform: expected 12 numbers, found \"{}\"", printable(text, 120)));
            value = *number;
        }
        const Affine affine{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}, {m[9], m[10], m[11]}}};
        if (!is_finite(affine)) fault("transform: is not finite");
        return affine;
    }
    /// #RRGGBB or #RRGGBBAA, in sRGB.
    Vec4f color(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = Words(attributes.get(name)).rest();
        if (text.empty() && !builder_.options().strict) {
            builder_.document().warn(fmt::format("{}: {} is missing; drawn in grey", part_, name));
            return {linear_color(0.7), linear_color(0.7), linear_color(0.7), 1.0f};
        }
        const std::optional<Vec4f> color = parse_color(text);
        if (!color) fault(fmt::format("{}: expected #RRGGBB or #RRGGBBAA, found \"{}\"", name, printable(text, 40)));
        return *color;
    }

    // ---- elements ------------------------------------------------------------------------------------------------------
    void begin_core(std::string_view name, const XmlAttributes& attributes) {
        if (name == "vertex") return add_vertex(attributes);
        if (name == "triangle") return add_triangle(attributes);
        if (name == "model") return begin_model(attributes);
        if (name == "object") return begin_object(attributes);
        if (name == "basematerials") return begin_properties(attributes, false);
        if (name == "base") return add_color(color(attributes, "displaycolor"));
        if (name == "component" || name == "item") {
            builder_.document().geometry.take(sizeof(Component));
            Component component{std::string(attributes.get(kProductionPath)), needed(attributes, "objectid"), transform(attributes),
                                Words(attributes.get("printable")).rest() != "0"};
            if (name == "item")
                model_.items.push_back(std::move(component));
            else if (object_ != nullptr)
                object_->components.push_back(std::move(component));
        }
    }
    void begin_material(std::string_view name, const XmlAttributes& attributes) {
        if (name == "colorgroup") return begin_properties(attributes, false);
        if (name == "color") return add_color(color(attributes, "color"));
        if (name == "texture2d") {
            builder_.document().geometry.take(sizeof(Texture2d) + 64);
            Texture2d texture{std::string(attributes.get("path"))};
            if (const char* u = attributes.find("tilestyleu")) texture.wrap_u = u;
            if (const char* v = attributes.find("tilestylev")) texture.wrap_v = v;
            model_.textures[needed(attributes, "id")] = std::move(texture);
            return;
        }
        if (name == "texture2dgroup") {
            begin_properties(attributes, true);
            properties_->texture = needed(attributes, "texid");
            return;
        }
        if (name == "tex2coord") {
            if (properties_ == nullptr || !properties_->is_texture) fault("a tex2coord is outside of a texture2dgroup");
            builder_.document().geometry.take(2 * sizeof(Vec2f));
            properties_->uvs.push_back({real<float>(attributes, "u"), 1.0f - real<float>(attributes, "v")});
            return;
        }
        if (name == "multiproperties" || name == "compositematerials") {
            begin_properties(attributes, false);
            Words layers(attributes.get(name == "multiproperties" ? "pids" : "matid"));
            properties_->layers = list(layers);
            Words indices(attributes.get("matindices"));
            properties_->indices = list(indices);
            properties_->multiplies = attributes.get("blendmethods").find("multiply") != std::string_view::npos;
            return;
        }
        if (name == "multi") return add_layers(attributes);
        if (name == "composite") return add_mixture(attributes);
        builder_.document().warn(fmt::format("{}: {} are not drawn", part_, name));
    }
    /// Whole numbers up to the end.
    std::vector<std::uint32_t> list(Words& words) const {
        std::vector<std::uint32_t> out;
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            builder_.document().geometry.take(8);
            out.push_back(parse_whole<std::uint32_t>(word).value_or(kNone));
        }
        return out;
    }
    /// An entry of several layers becomes one colour, or an entry of the texture among them.
    void add_layers(const XmlAttributes& attributes) {
        if (properties_ == nullptr || properties_->layers.empty()) fault("a multi is outside of multiproperties");
        Words words(attributes.get("pindices"));
        const std::vector<std::uint32_t> indices = list(words);
        Vec4f color{1, 1, 1, 1};
        for (std::size_t i = 0; i < properties_->layers.size(); ++i) {
            const std::uint32_t at = i < indices.size() ? indices[i] : 0;  // those left out are 0
            const auto found = model_.properties.find(properties_->layers[i]);
            if (found == model_.properties.end() || &found->second == properties_) continue;
            const Properties& layer = found->second;
            if (layer.is_texture && at < layer.uvs.size()) {
                properties_->is_texture = true;
                properties_->texture = layer.texture;
                builder_.document().geometry.take(2 * sizeof(Vec2f));
                properties_->uvs.push_back(layer.uvs[at]);
                return;
            }
            if (at >= layer.colors.size()) continue;
            const Vec4f& over = layer.colors[at];
            const auto mix = [&](float below, float above) {
                return properties_->multiplies ? below * above : above * over.w + below * (1.0f - over.w);
            };
            color = i == 0 ? over
                           : Vec4f{mix(color.x, over.x), mix(color.y, over.y), mix(color.z, over.z),
                                   properties_->multiplies ? color.w * over.w : over.w + color.w * (1.0f - over.w)};
        }
        if (properties_->is_texture)
            properties_->uvs.push_back({});  // an entry keeps its number
        else
            add_color(color);
    }
    /// A mixture of base materials becomes the mean of their colours.
    void add_mixture(const XmlAttributes& attributes) {
        if (properties_ == nullptr || properties_->layers.empty()) fault("a composite is outside of compositematerials");
        const auto base = model_.properties.find(properties_->layers[0]);
        Words words(attributes.get("values"));
        Vec4f sum{0, 0, 0, 0};
        float weights = 0.0f;
        for (const std::uint32_t index : properties_->indices) {
            const float weight = std::max(0.0f, parse_real<float>(words.next()).value_or(0.0f));
            if (base == model_.properties.end() || index >= base->second.colors.size()) continue;
            const Vec4f& color = base->second.colors[index];
            sum = {sum.x + weight * color.x, sum.y + weight * color.y, sum.z + weight * color.z, sum.w + weight * color.w};
            weights += weight;
        }
        const Vec4f grey{linear_color(0.7), linear_color(0.7), linear_color(0.7), 1.0f};
        const bool is_mean = weights > 0.0f && weights < 1e30f;
        add_color(is_mean ? Vec4f{sum.x / weights, sum.y / weights, sum.z / weights, sum.w / weights} : grey);
    }
    /// Elements of extensions that are not read; once for each.
    void warn_of_others(std::string_view name_space) {
        if (name_space == kTriangleSets || name_space == warned_of_) return;
        warned_of_ = name_space;
        builder_.document().warn(fmt::format("{}: elements of {} are not drawn", part_, printable(name_space, 120)));
    }
    /// A file says which extensions are needed to understand it, by their prefixes.
    void check_required(std::string_view prefixes) {
        Words words(prefixes);
        for (std::string_view prefix = words.next(); !prefix.empty(); prefix = words.next()) {
            const auto found = name_space_of_.find(std::string(prefix));
            const std::string_view name = found == name_space_of_.end() ? prefix : std::string_view(found->second);
            const std::string_view read[] = {kCore.substr(0, kCore.size() - 1), kMaterial.substr(0, kMaterial.size() - 1), kProduction,
                                             kTriangleSets};
            if (std::find(std::begin(read), std::end(read), name) != std::end(read)) continue;
            const std::string what = fmt::format("requiredextensions: \"{}\" is not supported", printable(name, 120));
            if (builder_.options().strict) fault(what);
            builder_.document().warn(fmt::format("{}: {}", part_, what));
        }
    }
    void begin_model(const XmlAttributes& attributes) {
        check_required(attributes.get("requiredextensions"));
        if (const char* unit = attributes.find("unit")) {
            model_.metres = metres_of(unit);
            if (model_.metres == 0) fault(fmt::format("unit: \"{}\" is none that 3MF has", printable(unit, 40)));
        }
    }
    void begin_object(const XmlAttributes& attributes) {
        const std::uint32_t id = needed(attributes, "id");
        builder_.document().geometry.take(sizeof(Object) + 64);
        const auto [entry, is_new] = model_.objects.try_emplace(id);
        if (!is_new) fault(fmt::format("there are two objects with the id {}", id));
        object_ = &entry->second;
        object_->name = attributes.get("name");
        const std::string_view type = attributes.get("type");
        object_->is_support = type == "support" || type == "solidsupport";
        object_group_ = whole(attributes, "pid").value_or(kNone);
        object_property_ = whole(attributes, "pindex").value_or(0);
    }
    void begin_properties(const XmlAttributes& attributes, bool is_texture) {
        builder_.document().geometry.take(sizeof(Properties) + 64);
        properties_ = &model_.properties[needed(attributes, "id")];
        *properties_ = {};
        properties_->is_texture = is_texture;
    }
    void add_color(const Vec4f& color) {
        if (properties_ == nullptr || properties_->is_texture) fault("a colour is outside of a group of colours");
        builder_.document().geometry.take(2 * sizeof(Vec4f));
        properties_->colors.push_back(color);
    }
    void add_vertex(const XmlAttributes& attributes) {
        if (object_ == nullptr) fault("a vertex is outside of an object");
        builder_.take_entries<Vec3d>(1);
        object_->vertices.push_back({real<double>(attributes, "x"), real<double>(attributes, "y"), real<double>(attributes, "z")});
    }
    void add_triangle(const XmlAttributes& attributes) {
        if (object_ == nullptr) fault("a triangle is outside of an object");
        builder_.document().geometry.take(sizeof(Triangle));
        builder_.take_triangles(1);
        Triangle triangle;
        triangle.vertex = {needed(attributes, "v1"), needed(attributes, "v2"), needed(attributes, "v3")};
        const auto own = whole(attributes, "pid"), p1 = whole(attributes, "p1");
        triangle.group = own.value_or(object_group_);
        const std::uint32_t first = p1.value_or(object_property_);
        triangle.property = {first, whole(attributes, "p2").value_or(first), whole(attributes, "p3").value_or(first)};
        const char* paint = attributes.find(kPaintBambu);
        if (paint == nullptr) paint = attributes.find(kPaintPrusa);
        if (paint != nullptr && *paint != '\0') {
            builder_.document().geometry.take(sizeof(object_->paints[0]) + std::string_view(paint).size());
            object_->paints.emplace_back(static_cast<std::uint32_t>(object_->triangles.size()), paint);
        }
        object_->triangles.push_back(triangle);
    }

    std::string part_;
    ModelBuilder& builder_;
    Model model_;
    std::map<std::string, std::string> name_space_of_;  ///< of a prefix
    std::string warned_of_;
    std::size_t line_ = 0;
    Object* object_ = nullptr;
    Properties* properties_ = nullptr;
    std::uint32_t object_group_ = kNone, object_property_ = 0;
};

}  // namespace

std::optional<Vec4f> three_mf::parse_color(std::string_view text) {
    text = Words(text).rest();
    std::uint32_t value = 0;
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (text.size() == 7) value = value << 8 | 0xFFu;
    const auto channel = [&](int shift) { return static_cast<double>(value >> shift & 0xFFu) / 255.0; };
    return Vec4f{linear_color(channel(24)), linear_color(channel(16)), linear_color(channel(8)), static_cast<float>(channel(0))};
}

Model read_three_mf_model(std::span<const std::byte> text, const std::string& where, ModelBuilder& builder) {
    ModelReader reader(where, builder);
    read_xml(text, where, reader);
    return reader.take();
}

}  // namespace halflit::io::detail
