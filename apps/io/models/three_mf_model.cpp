#include "apps/io/models/three_mf_model.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/xml_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <map>

namespace halflit::io::detail {

namespace {

using namespace three_mf;

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
/// Parts of the names of extensions, of any year. Sets of triangles are named groups; they say nothing about the picture.
constexpr std::string_view kMaterial = "/3dmanufacturing/material/", kProduction = "/3dmanufacturing/production/",
                           kTriangleSets = "/3dmanufacturing/trianglesets/", kLattice = "/3dmanufacturing/beamlattice/";

bool is_of(std::string_view space, std::string_view extension) { return space.find(extension) != std::string_view::npos; }

constexpr std::string_view kRead[] = {kMaterial, kProduction, kTriangleSets, kLattice};
constexpr std::uint64_t kUnitsALayer = 20;  ///< of charge_work

double metres_of(std::string_view unit) {
    constexpr std::pair<std::string_view, double> kUnits[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                                                              {"inch", 0.0254}, {"foot", 0.3048},     {"meter", 1.0}};
    for (const auto& [name, metres] : kUnits)
        if (same_word(unit, name)) return metres;
    return 0.0;
}

class ModelReader : public XmlSink {
public:
    ModelReader(std::string where, ModelBuilder& builder) : part_(std::move(where)), builder_(builder) {}

    Model take() {
        if (faults_ > 0) {
            const std::string more = faults_ == 1 ? "" : fmt::format(", and {} more faults", faults_ - 1);
            builder_.document().go_on_without(first_fault_, "read as well as it can be" + more);
        }
        return std::move(model_);
    }

    void begin(const XmlName& name, const XmlAttributes& attributes, std::size_t line) override {
        line_ = line;
        if (!core_) begin_text(name);
        if (name.space == *core_) return begin_core(name.local, attributes);
        if (is_of(name.space, kMaterial)) return begin_material(name.local, attributes);
        if (is_of(name.space, kLattice)) return begin_lattice(name.local, attributes);
        warn_of_others(name.space);
    }
    void declare(std::string_view prefix, std::string_view name_space) override {
        builder_.document().geometry.take(prefix.size() + name_space.size() + 128);
        name_space_of_[std::string(prefix)] = name_space;
        for (const std::string_view slicer : {"slic3r", "bambulab", "prusa"})
            if (name_space.find(slicer) != std::string_view::npos) model_.is_of_slicer = true;
    }
    void end(std::string_view local) override {
        if (local == "object") object_ = nullptr;
    }

private:
    /// A fault of an element, which gets some value or is left out. By the strict rules, throws LoadFailure.
    void fault(const std::string& what) const {
        if (faults_++ > 0) return;
        first_fault_ = {{ErrorCode::bad_input, fmt::format("{}: line {}: {}", part_, line_, what)}};
        if (builder_.options().strict) throw first_fault_;
    }

    // ---- attributes ----------------------------------------------------------------------------------------------------
    std::optional<std::uint32_t> whole(const XmlAttributes& attributes, std::string_view name) const {
        const char* text = attributes.find(name);
        if (text == nullptr) return std::nullopt;
        const auto value = parse_whole<std::uint32_t>(Words(text).rest());
        if (value && *value != kNone) return value;
        fault(fmt::format("{}: expected a whole number, found \"{}\"", name, printable(text, 40)));
        return std::nullopt;
    }
    /// kNone where it is not there.
    std::uint32_t needed(const XmlAttributes& attributes, std::string_view name) const {
        const auto value = whole(attributes, name);
        if (!value) fault(fmt::format("expected the attribute {}", name));
        return value.value_or(kNone);
    }
    /// Not a number where there is none.
    template <class T>
    T real(const XmlAttributes& attributes, std::string_view name) const {
        const char* text = attributes.find(name);
        const std::string_view word = Words(text == nullptr ? "" : text).rest();  // XML Schema allows white space around it
        if (const auto value = parse_real<T>(word)) return *value;
        fault(fmt::format("{}: expected a number, found \"{}\"", name, printable(word, 40)));
        return static_cast<T>(parse_loosely(word).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    /// Twelve numbers: the images of x, y and z, and that of the origin.
    Affine transform(const XmlAttributes& attributes) const {
        const char* text = attributes.find("transform");
        if (text == nullptr) return {};
        Words words(text);
        double m[12];
        for (double& value : m) value = parse_real<double>(words.next()).value_or(std::numeric_limits<double>::quiet_NaN());
        const Affine affine{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}, {m[9], m[10], m[11]}}};
        if (is_finite(affine)) return affine;
        fault(fmt::format("transform: expected 12 numbers, found \"{}\"", printable(text, 120)));
        return {};
    }
    /// #RRGGBB or #RRGGBBAA, in sRGB.
    Vec4f color(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = Words(attributes.get(name)).rest();
        if (const std::optional<Vec4f> color = parse_color(text)) return *color;
        fault(fmt::format("{}: expected #RRGGBB or #RRGGBBAA, found \"{}\"", name, printable(text, 40)));
        return kGrey;
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
            const char* path = attributes.find_prefixed("path");  // of the production extension
            Component component{path == nullptr ? "" : path, needed(attributes, "objectid"), transform(attributes),
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
            if (properties_ == nullptr || !properties_->is_texture) return fault("a tex2coord is outside of a texture2dgroup");
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
        if (properties_ == nullptr || properties_->layers.empty()) return fault("a multi is outside of multiproperties");
        Words words(attributes.get("pindices"));
        const std::vector<std::uint32_t> indices = list(words);
        Vec4f color{1, 1, 1, 1};
        charge_work(kUnitsALayer * properties_->layers.size());
        check_time();
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
        if (properties_ == nullptr || properties_->layers.empty()) return fault("a composite is outside of compositematerials");
        const auto base = model_.properties.find(properties_->layers[0]);
        Words words(attributes.get("values"));
        Vec4f sum{0, 0, 0, 0};
        float weights = 0.0f;
        for (const std::uint32_t index : properties_->indices) {
            const std::string_view word = words.next();
            if (word.empty()) break;  // the work goes by the text, however long the list of materials is
            const float weight = std::max(0.0f, parse_real<float>(word).value_or(0.0f));
            if (base == model_.properties.end() || index >= base->second.colors.size()) continue;
            const Vec4f& color = base->second.colors[index];
            sum = {sum.x + weight * color.x, sum.y + weight * color.y, sum.z + weight * color.z, sum.w + weight * color.w};
            weights += weight;
        }
        const bool is_mean = weights > 0.0f && weights < 1e30f;
        add_color(is_mean ? Vec4f{sum.x / weights, sum.y / weights, sum.z / weights, sum.w / weights} : kGrey);
    }
    void begin_lattice(std::string_view name, const XmlAttributes& attributes) {
        if (object_ == nullptr) return fault("a lattice is outside of an object");
        Lattice& lattice = object_->lattice;
        if (name == "beamlattice") {
            lattice_ = {{}, {object_property_, object_property_}, {0, 0}, {}, whole(attributes, "pid").value_or(object_group_)};
            lattice_.property.fill(whole(attributes, "pindex").value_or(object_property_));
            lattice_.radius.fill(real<double>(attributes, "radius"));
            lattice_.cap.fill(cap(attributes.get("cap"), Lattice::Cap::sphere));
            if (attributes.find("minlength") != nullptr) lattice.shortest = real<double>(attributes, "minlength");
            const auto prefixed = [&](const char* local) {
                const char* text = attributes.find_prefixed(local);
                return std::string_view(text == nullptr ? "" : text);
            };
            for (const char* mesh : {"clippingmesh", "representationmesh"})
                if (const auto id = whole(attributes, mesh)) lattice.meshes.push_back(*id);
            ball_radius_ = parse_real<double>(prefixed("ballradius")).value_or(0.0);
            if (prefixed("ballmode") == "all") lattice.ball_radius = ball_radius_;
            if (const std::string_view mode = attributes.get("clippingmode"); !mode.empty() && mode != "none")
                builder_.document().warn(fmt::format("{}: beams are not cut by their clippingmesh", part_));
        } else if (name == "beam") {
            builder_.document().geometry.take(2 * sizeof(Lattice::Beam));
            Lattice::Beam beam = lattice_;
            beam.vertex = {needed(attributes, "v1"), needed(attributes, "v2")};
            if (attributes.find("r1") != nullptr) beam.radius.fill(real<double>(attributes, "r1"));
            if (attributes.find("r2") != nullptr) beam.radius[1] = real<double>(attributes, "r2");
            beam.cap = {cap(attributes.get("cap1"), beam.cap[0]), cap(attributes.get("cap2"), beam.cap[1])};
            beam.group = whole(attributes, "pid").value_or(beam.group);
            if (const auto p1 = whole(attributes, "p1")) beam.property.fill(*p1);
            beam.property[1] = whole(attributes, "p2").value_or(beam.property[1]);
            lattice.beams.push_back(beam);
        } else if (name == "ball") {
            builder_.document().geometry.take(2 * sizeof(Lattice::Ball) + 64);
            const double radius = attributes.find("r") == nullptr ? ball_radius_ : real<double>(attributes, "r");
            lattice.balls[needed(attributes, "vindex")] = {radius, whole(attributes, "pid").value_or(lattice_.group),
                                                           whole(attributes, "p").value_or(lattice_.property[0])};
        }
    }
    static Lattice::Cap cap(std::string_view name, Lattice::Cap without) {
        return name == "sphere"       ? Lattice::Cap::sphere
               : name == "hemisphere" ? Lattice::Cap::hemisphere
               : name == "butt"       ? Lattice::Cap::butt
                                      : without;
    }
    /// The first element: its namespace is 3MF's, whatever it says.
    void begin_text(const XmlName& name) {
        core_ = name.space;
        if (name.space == kCore) return;
        const std::string what = fmt::format("{}: the namespace is \"{}\", expected \"{}\"", part_, printable(name.space, 120), kCore);
        builder_.document().go_on_without({{ErrorCode::bad_input, what}}, "read as that");
    }
    /// Elements of extensions that are not read; once for each.
    void warn_of_others(std::string_view name_space) {
        if (name_space.empty() || is_of(name_space, kTriangleSets) || name_space == warned_of_) return;
        warned_of_ = name_space;
        builder_.document().warn(fmt::format("{}: elements of {} are not drawn", part_, printable(name_space, 120)));
    }
    /// A file says which extensions are needed to understand it, by their prefixes.
    void check_required(std::string_view prefixes) {
        Words words(prefixes);
        for (std::string_view prefix = words.next(); !prefix.empty(); prefix = words.next()) {
            const auto found = name_space_of_.find(std::string(prefix));
            const std::string_view name = found == name_space_of_.end() ? prefix : std::string_view(found->second);
            const auto is_it = [&](std::string_view extension) { return is_of(name, extension); };
            if (name == kCore || std::any_of(std::begin(kRead), std::end(kRead), is_it)) continue;
            const std::string what = fmt::format("requiredextensions: \"{}\" is not supported", printable(name, 120));
            builder_.document().go_on_without({{ErrorCode::bad_input, fmt::format("{}: {}", part_, what)}}, "what is known is drawn");
        }
    }
    void begin_model(const XmlAttributes& attributes) {
        check_required(attributes.get("requiredextensions"));
        const char* unit = attributes.find("unit");
        if (unit == nullptr) return;
        if (const double metres = metres_of(Words(unit).rest()); metres > 0)
            model_.metres = metres;
        else
            fault(fmt::format("unit: \"{}\" is none that 3MF has", printable(unit, 40)));
    }
    void begin_object(const XmlAttributes& attributes) {
        const std::uint32_t id = needed(attributes, "id");
        builder_.document().geometry.take(sizeof(Object) + 64);
        const auto [entry, is_new] = model_.objects.try_emplace(id);
        if (!is_new) fault(fmt::format("there are two objects with the id {}; the first counts", id));
        object_ = is_new ? &entry->second : &(spare_ = {});
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
        if (properties_ == nullptr || properties_->is_texture) return fault("a colour is outside of a group of colours");
        builder_.document().geometry.take(2 * sizeof(Vec4f));
        properties_->colors.push_back(color);
    }
    void add_vertex(const XmlAttributes& attributes) {
        if (object_ == nullptr) return fault("a vertex is outside of an object");
        builder_.take_entries<Vec3d>(1);
        object_->vertices.push_back({real<double>(attributes, "x"), real<double>(attributes, "y"), real<double>(attributes, "z")});
    }
    void add_triangle(const XmlAttributes& attributes) {
        if (object_ == nullptr) return fault("a triangle is outside of an object");
        builder_.document().geometry.take(sizeof(Triangle));
        builder_.take_triangles(1);
        Triangle triangle;
        triangle.vertex = {needed(attributes, "v1"), needed(attributes, "v2"), needed(attributes, "v3")};
        const auto own = whole(attributes, "pid"), p1 = whole(attributes, "p1");
        triangle.group = own.value_or(object_group_);
        const std::uint32_t first = p1.value_or(object_property_);
        triangle.property = {first, whole(attributes, "p2").value_or(first), whole(attributes, "p3").value_or(first)};
        const char* paint = attributes.find("paint_color");                          // Bambu Studio
        if (paint == nullptr) paint = attributes.find_prefixed("mmu_segmentation");  // PrusaSlicer
        if (paint != nullptr && *paint != '\0') {
            builder_.document().geometry.take(sizeof(object_->paints[0]) + std::string_view(paint).size());
            object_->paints.emplace_back(static_cast<std::uint32_t>(object_->triangles.size()), paint);
        }
        object_->triangles.push_back(triangle);
    }

    const Vec4f kGrey{linear_color(0.7), linear_color(0.7), linear_color(0.7), 1.0f};
    std::string part_;
    ModelBuilder& builder_;
    Model model_;
    std::optional<std::string> core_;  ///< namespace of the first element
    mutable LoadFailure first_fault_;
    mutable std::size_t faults_ = 0;
    Object spare_;           ///< takes what is left out
    Lattice::Beam lattice_;  ///< what its beams have unless they say otherwise
    double ball_radius_ = 0.0;
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

Model read_three_mf_model(std::span<std::byte> text, const std::string& where, ModelBuilder& builder) {
    ModelReader reader(where, builder);
    read_xml(text, where, builder.document(), reader);
    return reader.take();
}

}  // namespace halflit::io::detail
