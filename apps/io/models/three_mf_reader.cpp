// 3MF: a ZIP file with models as XML. Read are meshes, components and build items with their transforms, the unit, base materials, groups
// of colours and of texture coordinates with their layers and mixtures, the parts of the production extension, and slicers' projects.
#include "apps/io/gltf/build/open.hpp"
#include "apps/io/models/model_builder.hpp"
#include "apps/io/models/model_readers.hpp"

#if HALFLIT_HAS_3MF
#include "apps/io/files/text.hpp"
#include "apps/io/models/formats.hpp"
#include "apps/io/models/model_text.hpp"
#include "apps/io/models/slicer_project.hpp"
#include "apps/io/models/three_mf_model.hpp"
#include "apps/io/models/three_mf_package.hpp"
#include "apps/io/models/xml_reader.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <span>
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
constexpr int kMostDepth = 64, kMostPlateDepth = 4;
constexpr std::size_t kMostBoundsWork = 100'000'000;  ///< vertices and components that are looked at to find plates
constexpr std::uint64_t kUnitsAVisit = 1000;          ///< of charge_work, for a component
constexpr std::uint64_t kMostPacked = 32;             ///< bytes of a mesh's text for each byte in the package, at most

/// Finds the names of the model and of its picture among the package's relations.
class RelationReader : public XmlSink {
public:
    void begin(const XmlName& name, const XmlAttributes& attributes, std::size_t) override {
        if (name.local != "Relationship") return;
        const std::string_view type = attributes.get("Type");
        if (type.ends_with("/3dmodel")) target = attributes.get("Target");
        if (type.ends_with("/metadata/thumbnail")) picture = attributes.get("Target");
    }
    void end(std::string_view) override {}
    std::string target, picture;
};

class ThreeMfReader {
public:
    ThreeMfReader(std::span<const std::byte> bytes, ModelBuilder& builder)
        : builder_(builder), package_(bytes, builder.document()), packed_(bytes.size()) {}

    double read() {
        Part& root = part(root_name());
        project_ = read_slicer_project(package_, builder_.document());
        std::erase_if(root.model.items, [&](const Component& item) {
            const bool is_lost = item.path.empty() && !root.model.objects.contains(item.object);
            if (is_lost) builder_.document().go_on_without(lost_object(root, item.object), "the item is left out");
            return is_lost;
        });
        if (root.model.items.empty()) root.model.items = objects_of(root);
        std::size_t left_out = 0;
        for (const Component* item : items_of_plate(root)) {
            if (!item->is_printable) {
                ++left_out;
                continue;
            }
            try {
                place(item->path.empty() ? root.name : item->path, *item, {}, root.model.metres, 0);
            } catch (const LoadFailure& failure) {
                builder_.document().go_on_without(failure, "the item is left out");
            }
        }
        if (left_out > 0) builder_.document().warn(fmt::format("{} items that are not to be printed are left out", left_out));
        if (helpers_ > 0)
            builder_.document().warn(
                fmt::format("{} modifiers, negative volumes and supports are left out: they are not printed", helpers_));
        const bool has_mesh = helpers_ > 0 || left_out > 0 || !builder_.loaded().scene.meshes.empty();
        if (builder_.loaded().scene.instances.empty() && !has_mesh) place_picture();
        return root.model.metres;
    }

private:
    struct Made {
        std::vector<int> meshes;
        bool has_something = false;  ///< it or a component of it has meshes
        bool is_open = false;        ///< while its components are looked at
    };
    struct Part {
        std::string name;
        Model model;
        std::map<std::uint32_t, Made> made;
        std::map<std::uint32_t, int> texture_material;
        std::optional<LoadFailure> failure;  ///< of reading it
    };

    /// The part that the package's relations name; where they name none, the usual one, or any of its kind.
    std::string root_name() {
        RelationReader reader;
        try {
            if (auto relations = package_.read("_rels/.rels")) read_xml(*relations, "_rels/.rels", builder_.document(), reader);
        } catch (const LoadFailure& failure) {
            builder_.document().go_on_without(failure, "the model is looked for by its name");
        }
        picture_ = reader.picture;
        std::vector<std::string> names{reader.target, kUsualModel};
        for (std::string& name : package_.names_ending(".model", 1)) names.push_back(std::move(name));
        for (std::string& name : names) {
            if (name.empty() || !package_.has(name)) continue;
            if (!reader.target.empty() && name != reader.target)
                builder_.document().go_on_without(
                    {{ErrorCode::bad_input, fmt::format("_rels/.rels: \"{}\" is not in the ZIP file", printable(reader.target, 120))}},
                    fmt::format("\"{}\" is read", printable(name, 120)));
            return std::move(name);
        }
        std::string found;
        for (const FormatRow& row : formats())
            for (const std::string& name : package_.names_ending(row.extension, 4))
                found += (found.empty() ? "" : ", ") + printable(name, 120);
        if (!found.empty()) refuse("", "is a ZIP file that holds " + found + "; unpack it");
        refuse("", "is a ZIP file without a model of 3MF in it");
    }

    /// Where a build has no items: the objects that are components of no other.
    std::vector<Component> objects_of(Part& root) {
        std::vector<Component> items;
        const auto mark = [&](std::uint32_t id) {
            if (const auto of = root.model.objects.find(id); of != root.model.objects.end()) of->second.is_component = true;
        };
        for (const auto& [id, object] : root.model.objects) {
            for (const Component& component : object.components)
                if (component.path.empty() || component.path == root.name) mark(component.object);
            for (const std::uint32_t mesh : object.lattice.meshes) mark(mesh);
        }
        for (const auto& [id, object] : root.model.objects)
            if (!object.is_component && !object.is_support) items.push_back({"", id, {}, true});
        builder_.document().geometry.take(items.size() * sizeof(Component));
        if (!items.empty())
            builder_.document().warn(printable(root.name, 120) + ": the build has no items that are there; all objects are drawn");
        return items;
    }

    // ---- plates --------------------------------------------------------------------------------------------------------
    /// The build's items on the plate that is asked for.
    std::vector<const Component*> items_of_plate(Part& root) {
        const int wanted = builder_.options().plate;
        if (wanted < 0) refuse("", fmt::format("plate is {}, expected at least 0", wanted), ErrorCode::usage);
        std::vector<const Component*> items;
        for (const Component& item : root.model.items) items.push_back(&item);
        if (wanted == 0 || items.empty()) return items;
        const std::vector<int> plate_of = project_.plates.empty() ? plates_of_objects(root, items) : named_plates(items);
        const int plates = project_.plates.empty() ? *std::max_element(plate_of.begin(), plate_of.end()) : project_.plates.rbegin()->first;
        if (plates > 1 && wanted > plates)
            refuse("", fmt::format("plate: the file has {}, expected one of them, found {}", plates, wanted), ErrorCode::usage);
        if (plates <= 1) return items;
        std::vector<const Component*> chosen;
        for (std::size_t i = 0; i < items.size(); ++i)
            if (plate_of[i] == wanted) chosen.push_back(items[i]);
        builder_.document().warn(fmt::format("plate {} of {} is drawn; plate 0 draws all", wanted, plates));
        return chosen;
    }

    /// 0: on none.
    std::vector<int> named_plates(const std::vector<const Component*>& items) const {
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> of_instance;
        for (const auto& [plate, list] : project_.plates)
            for (const SlicerProject::Placed& placed : list) of_instance[{placed.object, placed.instance}] = plate;
        std::map<std::uint32_t, std::uint32_t> instances;
        std::vector<int> plates;
        for (const Component* item : items) {
            check_time();
            const auto found = of_instance.find({item->object, instances[item->object]++});
            plates.push_back(found == of_instance.end() ? 0 : found->second);
        }
        return plates;
    }

    /// Grows a box by what an item is made of, as long as that takes little work.
    void add_bounds(const std::string& path, const Component& what, const Affine& parent, int depth, DoubleBox& box) {
        check_time();
        Part& in = part(path);
        const auto object = in.model.objects.find(what.object);
        if (object == in.model.objects.end() || depth > kMostPlateDepth || bounds_work_ > kMostBoundsWork) return;
        bounds_work_ += object->second.vertices.size() + 1;
        const Affine world = parent * what.transform;
        for (const Vec3d& vertex : object->second.vertices) box.include(transform_direction(world, vertex) + world.c[3]);
        for (const Component& component : object->second.components)
            add_bounds(component.path.empty() ? path : component.path, component, world, depth + 1, box);
    }

    /// Plates of a slicer's file that does not name them.
    std::vector<int> plates_of_objects(const Part& root, const std::vector<const Component*>& items) {
        constexpr std::size_t kMostItems = 256;
        const std::vector<int> one(items.size(), 1);
        if (!root.model.is_of_slicer || items.size() > kMostItems || root.model.metres != 0.001) return one;
        std::vector<DoubleBox> boxes(items.size());
        for (std::size_t i = 0; i < items.size(); ++i)
            add_bounds(items[i]->path.empty() ? root.name : items[i]->path, *items[i], {}, 0, boxes[i]);
        return bounds_work_ > kMostBoundsWork ? one : plates_by_place(boxes);
    }

    /// A file of machine code alone may hold a picture of the plate.
    void place_picture() {
        const std::string plate = fmt::format("Metadata/plate_{}.png", std::max(1, builder_.options().plate));
        for (const std::string& name : {plate, picture_, std::string("Metadata/thumbnail.png")}) {
            try {
                auto picture = name.empty() ? std::nullopt : package_.read(name);
                if (picture && builder_.place_card(*std::move(picture), name)) return;
            } catch (const LoadFailure& failure) {
                builder_.document().go_on_without(failure, "it is not drawn");
            }
        }
    }

    Part& part(const std::string& given) {
        const std::string name = given.starts_with('/') ? given.substr(1) : given;
        const auto [entry, is_new] = parts_.try_emplace(name);
        Part& part = entry->second;
        if (is_new) {
            try {
                read_part(name, part);
            } catch (const LoadFailure& failure) {
                part.failure = failure;
            }
        }
        if (part.failure) throw *part.failure;
        return part;
    }
    void read_part(const std::string& name, Part& part) {
        auto text = package_.read(name);
        if (!text) refuse(printable(name, 120), "is not in the ZIP file");
        // The limit for geometry goes by what was unpacked, as far as the text of a mesh can be packed.
        Document& document = builder_.document();
        unpacked_ += text->size();
        document.file_bytes = packed_ + std::min(unpacked_, kMostPacked * packed_);
        set_geometry_limit(document);
        part.name = name;
        part.model = read_three_mf_model(*text, printable(name, 120), builder_);
    }

    static LoadFailure lost_object(const Part& part, std::uint32_t id) {
        return {{ErrorCode::bad_input, fmt::format("{}: there is no object with the id {}", printable(part.name, 120), id)}};
    }
    /// The object's own meshes are made at its first use.
    Made& make(Part& part, std::uint32_t id, int depth) {
        const auto object = part.model.objects.find(id);
        if (object == part.model.objects.end()) throw lost_object(part, id);
        const auto [entry, is_new] = part.made.try_emplace(id);
        Made& made = entry->second;
        if (made.is_open) refuse(printable(part.name, 120), fmt::format("the object {} is a component of itself", id));
        if (!is_new) return made;
        if (depth > kMostDepth)
            refuse(printable(part.name, 120), fmt::format("more than {} components inside each other", kMostDepth), ErrorCode::limit);
        if (depth == 0) root_ = id;
        if (object->second.is_support || !project_.volume_of(root_, id).is_drawn) {
            ++helpers_;
            return made;
        }
        made.is_open = true;
        try {
            fill(made, part, object->second, id, depth);
        } catch (const LoadFailure&) {
            made.is_open = false;
            throw;
        }
        made.is_open = false;
        return made;
    }
    void fill(Made& made, Part& part, Object& object, std::uint32_t id, int depth) {
        apply_project(part, object, id);
        sweep_lattice(object, where_of(part, object), builder_);
        make_meshes_of(part, object, made);
        made.has_something = !made.meshes.empty();
        std::erase_if(object.components, [&](const Component& component) {
            try {
                Part& where = component.path.empty() ? part : this->part(component.path);
                const bool has = make(where, component.object, depth + 1).has_something;
                made.has_something = made.has_something || has;
                return !has;
            } catch (const LoadFailure& failure) {
                builder_.document().go_on_without(failure, "the component is left out");
                return true;
            }
        });
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
            charge_work(kUnitsAVisit);
            builder_.document().geometry.take(sizeof(Component));  // each visit leads to an instance, but depth costs too
            place(component.path.empty() ? path : component.path, component, world, root_metres, depth + 1);
        }
    }

    /// Takes what the slicer's project says into the object's triangles: those of volumes that are not printed go, painted ones are
    /// divided, and those without colours of their own get their filament's.
    void apply_project(Part& part, Object& object, std::uint32_t id) {
        auto runs = project_.runs.find(id);
        if (project_.filaments.empty() && object.paints.empty() && runs == project_.runs.end()) return;
        const bool has_colors = !project_.filaments.empty() || !object.paints.empty();
        using Run = SlicerProject::Run;
        if (runs != project_.runs.end())
            std::stable_sort(runs->second.begin(), runs->second.end(), [](const Run& a, const Run& b) { return a.first < b.first; });
        const SlicerProject::Volume whole = project_.volume_of(root_, id);
        std::vector<Triangle> kept;
        std::vector<PaintedTriangle> parts;
        auto paint = object.paints.begin();
        for (std::uint32_t i = 0; i < object.triangles.size(); ++i) {
            if (i % 4096 == 0) check_time();
            const bool is_painted = paint != object.paints.end() && paint->first == i;
            const std::string code = is_painted ? std::move((paint++)->second) : "";
            SlicerProject::Volume volume = whole;
            if (runs != project_.runs.end()) {
                const auto behind = std::upper_bound(runs->second.begin(), runs->second.end(), i,
                                                     [](std::uint32_t at, const Run& run) { return at < run.first; });
                if (behind != runs->second.begin() && i <= std::prev(behind)->last) volume = std::prev(behind)->volume;
            }
            if (!volume.is_drawn) continue;
            Triangle& triangle = object.triangles[i];
            parts.clear();
            const bool is_whole =
                std::all_of(triangle.vertex.begin(), triangle.vertex.end(), [&](std::uint32_t v) { return v < object.vertices.size(); });
            if (is_painted && is_whole) {
                builder_.document().geometry.take(code.size() * (4 * sizeof(PaintedTriangle) + 3 * sizeof(Vec3d)));
                divide_painted(triangle.vertex, code, object.vertices, parts);
                builder_.take_triangles(parts.size());
                builder_.take_entries<Vec3d>(2 * parts.size());
            } else {
                parts.push_back({triangle.vertex, 0});
            }
            for (const PaintedTriangle& one : parts) {
                builder_.document().geometry.take(sizeof(Triangle));
                Triangle made = triangle;
                made.vertex = one.vertex;
                if (has_colors && (triangle.group == kNone || one.filament > 0)) {
                    const int filament = one.filament > 0 ? one.filament : project_.filament_of(root_, volume);
                    made.group = kFilaments;
                    made.property.fill(static_cast<std::uint32_t>(filament - 1));
                }
                kept.push_back(made);
            }
        }
        if (kept.size() < object.triangles.size()) ++helpers_;
        object.triangles = std::move(kept);
        if (!has_colors) return;
        std::vector<Vec4f>& colors = part.model.properties[kFilaments].colors;
        if (colors.empty())
            for (int filament = 1; filament <= 256; ++filament) colors.push_back(project_.color_of(filament));
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
        const auto [entry, is_new] = part.texture_material.try_emplace(id, -1);
        if (!is_new) return entry->second;
        const auto texture = part.model.textures.find(id);
        const std::string where = fmt::format("{}: texture2d {}", printable(part.name, 120), id);
        Material material = builder_.loaded().scene.materials[static_cast<std::size_t>(builder_.colored_material())];
        try {
            if (texture == part.model.textures.end()) refuse(where, "is not there");
            auto picture = package_.read(texture->second.path);
            if (!picture) refuse(where, fmt::format("\"{}\" is not in the ZIP file", printable(texture->second.path, 120)));
            material.textures[TextureSlot::base_color].texture = builder_.texture(
                *std::move(picture), fmt::format("{} \"{}\"", where, printable(texture->second.path, 120)), ColorSpace::srgb);
        } catch (const LoadFailure& failure) {
            builder_.document().go_on_without(failure, "drawn in grey");
            return entry->second = builder_.grey_material();
        }
        const auto wrap = [](std::string_view style) {
            return style == "mirror" ? TextureWrap::mirror : style == "clamp" || style == "none" ? TextureWrap::clamp : TextureWrap::repeat;
        };
        material.textures[TextureSlot::base_color].sampler.wrap_u = wrap(texture->second.wrap_u);
        material.textures[TextureSlot::base_color].sampler.wrap_v = wrap(texture->second.wrap_v);
        return entry->second = builder_.add_material(material);
    }

    static std::string where_of(const Part& part, const Object& object) {
        return fmt::format("{}: object \"{}\"", printable(part.name, 120), printable(object.name, 80));
    }
    void make_meshes_of(Part& part, Object& object, Made& made) {
        if (object.triangles.empty()) return;
        const bool strict = builder_.options().strict;
        const std::string where = where_of(part, object);
        Soup soup;
        soup.positions = std::move(object.vertices);
        soup.normals = std::move(object.normals);
        const std::size_t without_normal = soup.positions.size() - soup.normals.size();
        std::vector<int> materials;
        std::map<int, std::uint32_t> part_of;                         // of a material
        std::vector<std::pair<Properties*, std::uint32_t>> in_lists;  // entries of groups that are in the soup's lists
        std::size_t bad = 0;
        std::uint32_t lost = kNone;  // a group that is not there
        for (const Triangle& triangle : object.triangles) {
            const auto found = triangle.group == kNone ? part.model.properties.end() : part.model.properties.find(triangle.group);
            Properties* properties = found == part.model.properties.end() ? nullptr : &found->second;
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
            for (const std::uint32_t v : triangle.vertex)
                if (!soup.normals.empty())
                    soup.normal_of.push_back(v < without_normal ? kNone : static_cast<std::uint32_t>(v - without_normal));
            if (properties == nullptr) continue;
            if (properties->place.empty()) {
                builder_.document().geometry.take(entries * sizeof(properties->place[0]));
                properties->place.assign(entries, kNone);
            }
            auto& list = properties->is_texture ? soup.uv_of : soup.color_of;
            list.resize(soup.position_of.size() - 3, kNone);
            for (const std::uint32_t i : triangle.property) {
                std::uint32_t& at = properties->place[i];
                if (at == kNone) {
                    in_lists.emplace_back(properties, i);
                    at = static_cast<std::uint32_t>(properties->is_texture ? soup.uvs.size() : soup.colors.size());
                    if (properties->is_texture)
                        soup.uvs.push_back(properties->uvs[i]);
                    else
                        soup.colors.push_back(properties->colors[i]);
                }
                list.push_back(at);
            }
        }
        for (const auto& [properties, entry] : in_lists) properties->place[entry] = kNone;
        object.triangles = {};
        if (bad > 0) builder_.document().warn(fmt::format("{}: {} triangles with indices out of range left out", where, bad));
        const std::vector<std::string> names(materials.size(), object.name);
        for (const PartMesh& mesh : builder_.add_meshes(std::move(soup), names, materials)) made.meshes.push_back(mesh.mesh);
    }

    ModelBuilder& builder_;
    ThreeMfPackage package_;
    std::uint64_t packed_, unpacked_ = 0;  ///< bytes
    std::map<std::string, Part> parts_;
    SlicerProject project_;
    std::string picture_;     ///< name of the package's own, or empty
    std::uint32_t root_ = 0;  ///< object of the build's item that is being placed
    std::size_t bounds_work_ = 0;
    std::size_t helpers_ = 0;  ///< objects and volumes that are left out
    int clear_ = -1;
};

}  // namespace

LoadedScene read_three_mf(std::span<const std::byte> bytes, const std::string& base_dir, const LoadOptions& options) {
    ModelBuilder builder(bytes, base_dir, options, "3MF");
    const double metres = ThreeMfReader(bytes, builder).read();
    return builder.finish({.up = UpAxis::z, .unit_m = metres});
}

#else

LoadedScene read_three_mf(std::span<const std::byte>, const std::string&, const LoadOptions&) {
    refuse("", "3MF files need the library expat, which this build lacks", ErrorCode::usage);
}

#endif

}  // namespace halflit::io::detail
