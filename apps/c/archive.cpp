// A scene as bytes, for copies and other processes of the same version of the library on machines of one byte order.
#include "apps/c/boundary.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/scene_handle.hpp"
#include "shading/environment.hpp"

#include <halflit/target.hpp>
#include <halflit/version.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace halflit::c {
namespace {

/// Appends values to bytes. visit() below is the one list of what is written and read.
class Writer {
public:
    static constexpr bool kReads = false;
    void raw(const void* from, std::size_t size) {
        const auto* const bytes = static_cast<const std::byte*>(from);
        bytes_.insert(bytes_.end(), bytes, bytes + size);
    }
    /// The number of entries of a list, each of which takes at least `least` bytes.
    std::size_t count(std::size_t n, std::size_t /*least*/) {
        const std::uint64_t stored = n;
        raw(&stored, sizeof stored);
        return n;
    }
    std::vector<std::byte> bytes_;
};

/// Takes them in the same order. After the end, or a count that the bytes cannot hold, it gives zeros and is not sound.
class Reader {
public:
    static constexpr bool kReads = true;
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    void raw(void* to, std::size_t size) {
        if (size > bytes_.size()) {
            sound_ = false;
            std::memset(to, 0, size);
            return;
        }
        if (size > 0) std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    std::size_t count(std::size_t /*n*/, std::size_t least) {
        std::uint64_t stored = 0;
        raw(&stored, sizeof stored);
        if (stored <= bytes_.size() / std::max<std::size_t>(least, 1)) return static_cast<std::size_t>(stored);
        sound_ = false;
        return 0;
    }
    void refuse() { sound_ = false; }
    [[nodiscard]] bool sound() const { return sound_; }
    [[nodiscard]] bool ended() const { return bytes_.empty(); }

private:
    std::span<const std::byte> bytes_;
    bool sound_ = true;
};

/// Whether each of its bytes is a part of its value, and any bytes make one. Structs with padding or truths are visited by member.
template <class T>
constexpr bool kIsPlain = !std::is_same_v<T, bool> && (std::is_arithmetic_v<T> || std::is_enum_v<T>);
#define HALFLIT_PLAIN(T, Number, count) \
    template <>                         \
    constexpr bool kIsPlain<T> = sizeof(T) == (count) * sizeof(Number);
HALFLIT_PLAIN(Vec2f, float, 2)
HALFLIT_PLAIN(Vec3f, float, 3)
HALFLIT_PLAIN(Vec4f, float, 4)
HALFLIT_PLAIN(Vec3d, double, 3)
HALFLIT_PLAIN(Mat4, float, 16)
HALFLIT_PLAIN(ViewSides, float, 4)
HALFLIT_PLAIN(Ambient, float, 6)
HALFLIT_PLAIN(NodeTransform, double, 12)
HALFLIT_PLAIN(Sampler, std::uint8_t, 5)
#undef HALFLIT_PLAIN

template <class Io, class T>
requires kIsPlain<T>
void visit(Io& io, T& value) { io.raw(&value, sizeof value); }
template <class Io>
void visit(Io& io, bool& truth) {
    std::uint8_t byte = truth ? 1 : 0;
    visit(io, byte);
    truth = byte != 0;
}
template <class Io>
void visit(Io& io, std::string& text) {
    text.resize(io.count(text.size(), 1));
    io.raw(text.data(), text.size());
}
template <class Io>
void visit(Io& io, Light& light);
template <class Io>
void visit(Io& io, Instance& instance);
template <class Io>
void visit(Io& io, Mesh& mesh);
template <class Io>
void visit(Io& io, Material& material);
template <class Io>
void visit(Io& io, Camera& camera);
template <class Io>
void visit(Io& io, Node& node);
template <class Io>
void visit(Io& io, AnimationInfo& animation);
template <class Io>
void visit(Io& io, Texture& texture);
template <class Io>
void visit(Io& io, FreePlaces& places);

template <class Io, class T>
void visit(Io& io, std::vector<T>& list) {
    if constexpr (kIsPlain<T>) {
        list.resize(io.count(list.size(), sizeof(T)));
        io.raw(list.data(), list.size() * sizeof(T));
    } else {
        list.resize(io.count(list.size(), sizeof(std::uint64_t)));  // each takes more
        for (T& one : list) visit(io, one);
    }
}
/// Maps, by pairs.
template <class Io, class Map>
requires requires { typename Map::mapped_type; }
void visit(Io& io, Map& map) {
    const std::size_t n = io.count(map.size(), 1);
    if constexpr (Io::kReads) {
        map.clear();
        for (std::size_t i = 0; i < n; ++i) {
            typename Map::key_type key{};
            typename Map::mapped_type value{};
            visit(io, key), visit(io, value);
            map.insert_or_assign(std::move(key), std::move(value));
        }
    } else {
        for (auto& [key, value] : map) {
            auto copy = key;
            visit(io, copy), visit(io, value);
        }
    }
}

template <class Io, class... Values>
void all(Io& io, Values&... values) {
    (visit(io, values), ...);
}

template <class Io>
void visit(Io& io, Light& l) {
    visit(io, l.type);
#define HALFLIT_LIGHT(member, ...) visit(io, l.member);
#include "shading/light_members.def"
}
template <class Io>
void visit(Io& io, Instance& i) {
    all(io, i.mesh, i.world_from_object, i.material, i.color, i.visible, i.backdrop);
}
template <class Io>
void visit(Io& io, TextureUse& use) {
    all(io, use.texture, use.uv_set, use.sampler, use.row_u, use.row_v);
}
template <class Io>
void visit(Io& io, Lobe& lobe) {
    all(io, lobe.wrap, lobe.power, lobe.normalize);
}
template <class Io>
void visit(Io& io, Mesh& m) {
    all(io, m.name, m.positions, m.normals, m.tangents, m.uv0, m.uv1, m.colors, m.indices, m.material, m.topology);
    bool has_splats = m.splats != nullptr;
    visit(io, has_splats);
    if (!has_splats) return;
    Splats splats = m.splats != nullptr ? *m.splats : Splats{};
    all(io, splats.rotations, splats.scales, splats.opacities, splats.degree, splats.harmonics, splats.reference, splats.linear_light);
    if constexpr (Io::kReads) m.splats = std::make_shared<const Splats>(std::move(splats));
}
template <class Io>
void visit(Io& io, Material& m) {
    all(io, m.name, m.alpha_mode, m.double_sided, m.unlit, m.has_own_lobe, m.shadow_catcher, m.lobe);
#define HALFLIT_NUMBER(member, ...) visit(io, m.member);
#define HALFLIT_TEXTURE(slot, ...) visit(io, m.textures[TextureSlot::slot]);
#include "shading/material_properties.def"
}
template <class Io>
void visit(Io& io, Camera& c) {
    all(io, c.name, c.world_from_camera);
#define HALFLIT_CAMERA(member, ...) visit(io, c.member);
#include "raster/camera_members.def"
    bool has_sides = c.sides.has_value();
    ViewSides sides = c.sides.value_or(ViewSides{});
    all(io, has_sides, sides);
    c.sides = has_sides ? std::optional(sides) : std::nullopt;
}
template <class Io>
void visit(Io& io, Node& n) {
    all(io, n.name, n.parent, n.parent_from_node, n.instances, n.node_from_instance, n.camera, n.light);
}
template <class Io>
void visit(Io& io, AnimationInfo& a) {
    all(io, a.name, a.end_s, a.channels);
}
/// Its texels in full size, of which the smaller levels follow.
template <class Io>
void visit(Io& io, Texture& t) {
    std::int32_t width = t.width(), height = t.height();
    MipRule rule = t.rule();
    all(io, width, height, rule);
    const bool fits = width > 0 && height > 0 && width <= kMaxTextureSide && height <= kMaxTextureSide;
    const std::size_t values = fits ? std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height) : 0;
    if constexpr (Io::kReads) {
        std::vector<std::uint16_t> texels;
        visit(io, texels);
        t = {};
        if (rule > MipRule::normal || texels.size() != values) return io.refuse();
        if (values == 0) return;
        if (auto made = Texture::from_rgba16(texels, width, height, rule)) t = std::move(*made);
    } else {
        io.count(values, sizeof(std::uint16_t));
        io.raw(t.data().data(), values * sizeof(std::uint16_t));
    }
}

/// The image of an environment, and how it was made.
struct EnvironmentSource {
    EnvironmentImage image;
    double rotate_rad = 0.0;
    bool has_suns = false, kept_light = false;
};
template <class Io>
void visit(Io& io, EnvironmentSource& e) {
    all(io, e.image.width, e.image.height, e.image.rgb, e.image.calibrated, e.rotate_rad, e.has_suns, e.kept_light);
}

/// The parts of a scene's handle that are kept.
struct Archive {
    std::string version = halflit::version();
    std::size_t struct_size = sizeof(halflit_material) + sizeof(Mat4);
    Scene scene;
    EnvironmentSource environment;
    std::vector<std::string> warnings;
    std::vector<AnimationInfo> animations;
    Placement placement;
    bool up_is_set = false;
    std::vector<Node> nodes;
    std::vector<int> node_of_instance;
    std::map<std::size_t, std::string> instance_names;
    FreePlaces free_meshes, free_instances, free_lights, free_textures;
    std::size_t file_meshes = 0;
    std::map<std::size_t, bool> added_without_normals;
    GivenMeshes given_meshes;
};
template <class Io>
void visit(Io& io, FreePlaces& places) {
    std::vector<std::size_t> free(places.all().begin(), places.all().end());
    std::size_t kept = places.kept();
    all(io, free, kept);
    places = {};
    places.keep(kept);
    for (const std::size_t index : free) places.add(index);
}
template <class Io>
void visit(Io& io, Archive& a) {
    Scene& s = a.scene;
    all(io, a.version, a.struct_size);
    all(io, s.lights, s.ambient, s.suns, s.sun_shadow_radius_rad, s.calibrated, s.meshes, s.instances, s.materials, s.textures, s.cameras,
        s.faces_back, s.frame_work);
    all(io, a.environment, a.warnings, a.animations, a.placement.origin, a.placement.scale, a.placement.mesh_scales, a.placement.up);
    all(io, a.up_is_set, a.nodes, a.node_of_instance, a.instance_names, a.free_meshes, a.free_instances, a.free_lights, a.free_textures);
    all(io, a.file_meshes, a.added_without_normals, a.given_meshes);
}

bool in(int index, std::size_t count) { return index >= -1 && (index < 0 || static_cast<std::size_t>(index) < count); }
template <class List, class Test>
bool each(const List& list, const Test& test) {
    return std::all_of(list.begin(), list.end(), test);
}

bool is_sound(const Splats& s, const Mesh& mesh) {
    if (s.degree < 0 || s.degree > 4) return false;
    const std::size_t count = s.opacities.size(), coefficients = harmonics_per_splat(s.degree);
    return mesh.topology == Topology::points && s.reference <= SplatReference::mip && count <= mesh.positions.size() &&
           s.rotations.size() == count && s.scales.size() == count && s.harmonics.size() == coefficients * count;
}
bool is_sound(const Mesh& mesh, const Scene& scene) {
    const std::size_t n = mesh.positions.size();
    const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
    return in(mesh.material, scene.materials.size()) && mesh.topology <= Topology::points && fits(mesh.normals.size()) &&
           fits(mesh.tangents.size()) && fits(mesh.uv0.size()) && fits(mesh.uv1.size()) && fits(mesh.colors.size()) &&
           each(mesh.indices, [n](std::uint32_t i) { return i < n; }) && (mesh.splats == nullptr || is_sound(*mesh.splats, mesh));
}
bool is_sound(const TextureUse& use, const Scene& scene) {
    const Sampler& s = use.sampler;
    return in(use.texture, scene.textures.size()) && (use.uv_set == 0 || use.uv_set == 1) && s.wrap_u <= TextureWrap::clamp &&
           s.wrap_v <= TextureWrap::clamp && s.mag <= TextureFilter::linear && s.min <= TextureFilter::linear && s.mip <= MipFilter::linear;
}
bool is_sound(const Node& node, const Archive& a) {
    return in(node.parent, a.nodes.size()) && in(node.camera, a.scene.cameras.size()) && in(node.light, a.scene.lights.size()) &&
           each(node.instances, [&](int i) { return i >= 0 && in(i, a.scene.instances.size()); });
}

/// Whether all indices and enumerations are in range, as the functions of this interface rely on.
bool is_sound(const Archive& a) {
    const Scene& s = a.scene;
    const auto free_of = [](const FreePlaces& free, std::size_t count) {
        return each(free.all(), [=](std::size_t i) { return i < count; });
    };
    return each(s.meshes, [&](const Mesh& m) { return is_sound(m, s); }) &&
           each(a.given_meshes, [&](const auto& m) { return m.first < s.meshes.size() && is_sound(m.second, s); }) &&
           each(s.instances,
                [&](const Instance& i) { return i.mesh >= 0 && in(i.mesh, s.meshes.size()) && in(i.material, s.materials.size()); }) &&
           each(s.materials,
                [&](const Material& m) {
                    return m.alpha_mode <= AlphaMode::blend && each(m.textures, [&](const TextureUse& use) { return is_sound(use, s); });
                }) &&
           each(s.lights, [](const Light& l) { return l.type <= LightType::spot; }) && a.placement.up <= UpAxis::minus_z &&
           each(a.nodes, [&](const Node& n) { return is_sound(n, a); }) && a.node_of_instance.size() <= s.instances.size() &&
           each(a.node_of_instance, [&](int node) { return in(node, a.nodes.size()); }) && a.file_meshes <= s.meshes.size() &&
           free_of(a.free_meshes, s.meshes.size()) && free_of(a.free_instances, s.instances.size()) &&
           free_of(a.free_lights, s.lights.size()) && free_of(a.free_textures, s.textures.size());
}

/// All that a scene has but what its animations need. Fails (usage) for an environment whose image was not kept.
Result<std::vector<std::byte>> archived(const halflit_scene& scene) {
    Archive a;
    a.scene = scene.scene;
    if (const auto& environment = scene.scene.environment) {
        if (environment->rgb.empty() || environment->studio_level != 0.0f)
            return fail(ErrorCode::usage, "expected a scene without a studio, and whose environment kept its image");
        a.environment = {{environment->width, environment->height, environment->rgb, environment->calibrated},
                         environment->rotate_rad,
                         !environment->suns.empty(),
                         environment->kept_light};
    }
    a.warnings = scene.warnings, a.animations = scene.animations, a.placement = scene.world.placement(), a.up_is_set = scene.up_is_set;
    a.nodes = scene.nodes, a.node_of_instance = scene.node_of_instance, a.instance_names = scene.instance_names;
    a.free_meshes = scene.free_meshes, a.free_instances = scene.free_instances;
    a.free_lights = scene.free_lights, a.free_textures = scene.free_textures;
    a.file_meshes = scene.file_meshes, a.added_without_normals = scene.added_without_normals, a.given_meshes = scene.given_meshes;
    Writer writer;
    visit(writer, a);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(writer.bytes_.data());
    const std::uint64_t hash = pixel_hash({bytes, writer.bytes_.size()});
    writer.raw(&hash, sizeof hash);
    return std::move(writer.bytes_);
}

/// Replaces the scene's content; it keeps what its own animations need. Fails (bad_input), with the scene unchanged, for bytes of another
/// version or that are damaged, and for indices out of range.
Result<void> restore(std::span<const std::byte> bytes, halflit_scene& scene) {
    const auto refused = [] { return fail(ErrorCode::bad_input, "expected the bytes of a scene of this version of halflit, whole"); };
    std::uint64_t hash = 0;
    if (bytes.size() < sizeof hash) return refused();
    const std::span<const std::byte> body = bytes.first(bytes.size() - sizeof hash);
    std::memcpy(&hash, body.data() + body.size(), sizeof hash);
    if (hash != pixel_hash({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()})) return refused();
    const Archive own;
    Archive a;
    Reader reader(body);
    visit(reader, a);
    if (!reader.sound() || !reader.ended() || a.version != own.version || a.struct_size != own.struct_size || !is_sound(a))
        return refused();
    if (!a.environment.image.rgb.empty()) {
        EnvironmentOptions options;
        options.extract_suns = a.environment.has_suns, options.rotate_rad = a.environment.rotate_rad;
        options.keep_image = true, options.keep_light = a.environment.kept_light;
        auto made = make_environment(std::move(a.environment.image), options);
        if (!made) return tl::unexpected<Error>(made.error());
        a.scene.environment = std::move(*made);
    }
    scene.scene = std::move(a.scene);
    scene.warnings = std::move(a.warnings), scene.animations = std::move(a.animations), scene.world = World(std::move(a.placement));
    scene.up_is_set = a.up_is_set, scene.nodes = std::move(a.nodes), scene.node_of_instance = std::move(a.node_of_instance);
    scene.instance_names = std::move(a.instance_names), scene.free_meshes = std::move(a.free_meshes);
    scene.free_instances = std::move(a.free_instances), scene.free_lights = std::move(a.free_lights);
    scene.free_textures = std::move(a.free_textures), scene.file_meshes = a.file_meshes;
    scene.added_without_normals = std::move(a.added_without_normals), scene.given_meshes = std::move(a.given_meshes);
    scene.changes.structure();
    return {};
}

}  // namespace
}  // namespace halflit::c

using namespace halflit;
using namespace halflit::c;

int32_t halflit_scene_save(const halflit_scene* scene, halflit_write write, void* user) {
    return reading(__func__, scene, {}, [&]() -> Result<void> {
        if (write == nullptr) return fail(ErrorCode::usage, "write is null");
        const auto bytes = archived(*scene);
        if (!bytes) return tl::unexpected<Error>(bytes.error());
        write(user, bytes->data(), bytes->size());
        return {};
    });
}

int32_t halflit_scene_restore(halflit_scene* scene, const void* bytes, size_t count) {
    return changing(__func__, scene, {{bytes, "bytes"}}, [&] { return restore({static_cast<const std::byte*>(bytes), count}, *scene); });
}
