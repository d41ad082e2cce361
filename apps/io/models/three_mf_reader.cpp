// 3MF: a ZIP file with models as XML. Read are meshes, components and build items with their transforms, the unit, base materials, groups
// of colours and of texture coordinates, and the parts of the production extension.
#include "apps/io/gltf/build/open.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"

#if HALFLIT_HAS_3MF
#include "apps/io/files/text.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/three_mf_model.hpp"
#include "apps/io/models/three_mf_package.hpp"
#include "apps/io/models/xml_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#endif

namespace halflit {

bool has_three_mf() { return HALFLIT_HAS_3MF != 0; }

}  // namespace halflit

namespace halflit::io::detail {

#if HALFLIT_HAS_3MF

namespace {

using namespace three_mf;

constexpr const char* kUsualModel = "3D/3dmodel.model";
constexpr int kMostDepth = 64;
constexpr std::uint64_t kMostPacked = 32;  ///< bytes of a mesh's text for each byte in the package, at most

/// Finds the model's name among the package's relations.
class RelationReader : public XmlSink {
public:
    void begin(std::string_view name, const XmlAttributes& attributes, std::size_t) override {
        if (name.ends_with(" Relationship") && attributes.get("Type") == "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel")
            target = attributes.get("Target");
    }
    void end(std::string_view) override {}
    std::string target;
};

class ThreeMfReader {
public:
    ThreeMfReader(std::span<const std::byte> bytes, ModelBuilder& builder)
        : builder_(builder), package_(bytes, builder.document()), packed_(bytes.size()) {}

    double read() {
        Part& root = part(root_name());
        for (const Component& item : root.model.items) {
            const std::string& path = item.path.empty() ? root.name : item.path;
            place(path, item, {}, root.model.metres, 0);
        }
        if (root.model.items.empty()) builder_.document().warn("the build has no items: nothing is drawn");
        return root.model.metres;
    }

private:
    struct Made {
        std::vector<int> meshes;
        bool is_made = false;
        bool has_something = false;  ///< it or a component of it has meshes
        bool is_open = false;        ///< while its components are looked at
    };
    struct Part {
        std::string name;
        Model model;
        std::map<std::uint32_t, Made> made;
        std::map<std::pair<std::uint32_t, bool>, int> texture_material;
    };

    std::string root_name() {
        const auto relations = package_.read("_rels/.rels");
        if (!relations) return kUsualModel;
        RelationReader reader;
        read_xml(*relations, "_rels/.rels", reader);
        return reader.target.empty() ? kUsualModel : reader.target;
    }

    Part& part(const std::string& given) {
        const std::string name = given.starts_with('/') ? given.substr(1) : given;
        const auto [entry, is_new] = parts_.try_emplace(name);
        if (!is_new) return entry->second;
        const auto text = package_.read(name);
        if (!text) refuse(printable(name, 120), "is not in the ZIP file; is it a 3MF model?");
        // The limit for geometry goes by what was unpacked, as far as the text of a mesh can be packed.
        Document& document = builder_.document();
        unpacked_ += text->size();
        document.file_bytes = packed_ + std::min(unpacked_, kMostPacked * packed_);
        set_geometry_limit(document);
        entry->second.name = name;
        entry->second.model = read_three_mf_model(*text, printable(name, 120), builder_);
        return entry->second;
    }

    /// The object's own meshes are made at its first use.
    Made& make(Part& part, std::uint32_t id, int depth) {
        const auto object = part.model.objects.find(id);
        if (object == part.model.objects.end()) refuse(printable(part.name, 120), fmt::format("there is no object with the id {}", id));
        Made& made = part.made[id];
        if (made.is_open) refuse(printable(part.name, 120), fmt::format("the object {} is a component of itself", id));
        if (made.is_made) return made;
        if (depth > kMostDepth)
            refuse(printable(part.name, 120), fmt::format("more than {} components inside each other", kMostDepth), ErrorCode::limit);
        made.is_open = true;
        make_meshes_of(part, object->second, made);
        made.has_something = !made.meshes.empty();
        for (const Component& component : object->second.components) {
            Part& where = component.path.empty() ? part : this->part(component.path);
            const bool has = make(where, component.object, depth + 1).has_something;
            made.has_something = made.has_something || has;
        }
        made.is_open = false;
        made.is_made = true;
        return made;
    }

    void place(const std::string& path, const Component& what, const Affine& parent, double root_metres, int depth) {
        check_time();
        if (depth > kMostDepth)  // an object that is made already may have any depth below it
            refuse(path, fmt::format("more than {} components inside each other", kMostDepth), ErrorCode::limit);
        Part& in = part(path);
        const Made& made = make(in, what.object, depth);
        if (!made.has_something) return;
        const Affine world = parent * what.transform;
        const Object& object = in.model.objects.at(what.object);
        if (!made.meshes.empty()) {
            const double s = in.model.metres / root_metres;
            const Affine units{{{s, 0, 0}, {0, s, 0}, {0, 0, s}, {0, 0, 0}}};
            if (!is_finite(world)) refuse("", fmt::format("the transforms of the object {} are not finite together", what.object));
            builder_.place(made.meshes, object.name, s == 1.0 ? world : world * units);
        }
        for (const Component& component : object.components) {
            builder_.document().geometry.take(sizeof(Component));  // each visit leads to an instance, but depth costs too
            place(component.path.empty() ? path : component.path, component, world, root_metres, depth + 1);
        }
    }

    /// The material of a triangle, and whether it has colours.
    int material_of(Part& part, const Triangle& triangle, const Properties* properties) {
        if (properties == nullptr) return builder_.grey_material();
        if (properties->is_texture) return texture_material(part, properties->texture);
        const auto is_clear = [&](std::uint32_t i) { return properties->colors[i].w < 1.0f; };
        return std::any_of(triangle.property.begin(), triangle.property.end(), is_clear) ? clear_material() : builder_.colored_material();
    }
    int clear_material() {
        if (clear_ < 0) {
            Material clear = builder_.loaded().scene.materials[static_cast<std::size_t>(builder_.colored_material())];
            clear.alpha_mode = AlphaMode::blend;
            clear_ = builder_.add_material(clear);
        }
        return clear_;
    }
    int texture_material(Part& part, std::uint32_t id) {
        const auto [entry, is_new] = part.texture_material.try_emplace({id, false}, -1);
        if (!is_new) return entry->second;
        const auto texture = part.model.textures.find(id);
        const std::string where = fmt::format("{}: texture2d {}", printable(part.name, 120), id);
        if (texture == part.model.textures.end()) refuse(where, "is not there");
        auto picture = package_.read(texture->second.path);
        if (!picture) refuse(where, fmt::format("\"{}\" is not in the ZIP file", printable(texture->second.path, 120)));
        Material material = builder_.loaded().scene.materials[static_cast<std::size_t>(builder_.colored_material())];
        material.textures[TextureSlot::base_color].texture =
            builder_.texture(*std::move(picture), fmt::format("{} \"{}\"", where, printable(texture->second.path, 120)), ColorSpace::srgb);
        const auto wrap = [](std::string_view style) {
            return style == "mirror" ? TextureWrap::mirror : style == "clamp" || style == "none" ? TextureWrap::clamp : TextureWrap::repeat;
        };
        material.textures[TextureSlot::base_color].sampler.wrap_u = wrap(texture->second.wrap_u);
        material.textures[TextureSlot::base_color].sampler.wrap_v = wrap(texture->second.wrap_v);
        return entry->second = builder_.add_material(material);
    }

    void make_meshes_of(Part& part, Object& object, Made& made) {
        if (object.triangles.empty()) return;
        const bool strict = builder_.options().strict;
        const std::string where = fmt::format("{}: object \"{}\"", printable(part.name, 120), printable(object.name, 80));
        Soup soup;
        soup.positions = std::move(object.vertices);
        std::vector<int> materials;
        std::map<int, std::uint32_t> part_of;             // of a material
        std::map<std::uint32_t, std::uint32_t> first_of;  // of a group: where its entries begin in the soup's list
        std::size_t bad = 0;
        std::uint32_t lost = kNone;  // a group that is not there
        for (const Triangle& triangle : object.triangles) {
            const auto found = triangle.group == kNone ? part.model.properties.end() : part.model.properties.find(triangle.group);
            const Properties* properties = found == part.model.properties.end() ? nullptr : &found->second;
            if (properties == nullptr && triangle.group != kNone && triangle.group != lost)
                builder_.document().warn(fmt::format("{}: there is no group {} of colours; drawn in grey", where, triangle.group));
            if (properties == nullptr) lost = triangle.group;
            const std::size_t entries = properties == nullptr    ? 0
                                        : properties->is_texture ? properties->uvs.size()
                                                                 : properties->colors.size();
            const auto out_of = [](const std::array<std::uint32_t, 3>& list, std::size_t count) {
                return std::any_of(list.begin(), list.end(), [&](std::uint32_t i) { return i >= count; });
            };
            if (out_of(triangle.vertex, soup.positions.size())) {
                if (strict) refuse(where, fmt::format("a triangle has a vertex out of range: there are {}", soup.positions.size()));
                ++bad;
                continue;
            }
            if (properties != nullptr && out_of(triangle.property, entries)) {
                builder_.document().warn(fmt::format("{}: a triangle has a colour out of range: group {} has {}; drawn in grey", where,
                                                     triangle.group, entries));
                properties = nullptr;
            }
            const int material = material_of(part, triangle, properties);
            const auto [entry, is_new] = part_of.try_emplace(material, static_cast<std::uint32_t>(materials.size()));
            if (is_new) materials.push_back(material);
            soup.part_of.push_back(entry->second);
            soup.position_of.insert(soup.position_of.end(), triangle.vertex.begin(), triangle.vertex.end());
            if (properties == nullptr) continue;
            auto [first, is_first] = first_of.try_emplace(triangle.group, 0);
            if (is_first) {
                builder_.take_entries<Vec4f>(entries);
                first->second = static_cast<std::uint32_t>(properties->is_texture ? soup.uvs.size() : soup.colors.size());
                soup.uvs.insert(soup.uvs.end(), properties->uvs.begin(), properties->uvs.end());
                soup.colors.insert(soup.colors.end(), properties->colors.begin(), properties->colors.end());
            }
            auto& list = properties->is_texture ? soup.uv_of : soup.color_of;
            list.resize(soup.position_of.size() - 3, kNone);
            for (const std::uint32_t i : triangle.property) list.push_back(first->second + i);
        }
        object.triangles = {};
        if (bad > 0) builder_.document().warn(fmt::format("{}: {} triangles with indices out of range left out", where, bad));
        const std::vector<std::string> names(materials.size(), object.name);
        for (const PartMesh& mesh : builder_.add_meshes(std::move(soup), names, materials)) made.meshes.push_back(mesh.mesh);
    }

    ModelBuilder& builder_;
    ThreeMfPackage package_;
    std::uint64_t packed_, unpacked_ = 0;  ///< bytes
    std::map<std::string, Part> parts_;
    int clear_ = -1;
};

}  // namespace

LoadedScene read_three_mf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "3MF");
    const double metres = ThreeMfReader(bytes, builder).read();
    return builder.finish({.up = UpAxis::z, .metres = metres});
}

#else

LoadedScene read_three_mf(std::span<const std::byte>, const std::string&, const LoadOptions&) {
    refuse("", "3MF files need the libraries libzip and expat, which this build lacks", ErrorCode::usage);
}

#endif

}  // namespace halflit::io::detail
