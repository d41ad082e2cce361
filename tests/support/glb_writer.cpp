#include "tests/support/glb_writer.hpp"

#include "halflit/image.hpp"
#include "sh/trig.hpp"
#include "shading/material_properties.hpp"
#include "tests/support/cameras.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::test {
namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126, kUnsigned = 5125;

class Writer {
public:
    explicit Writer(const GlbContent& content) : content_(content), scene_(content.scene) {}

    Result<std::string> file() {
        root_["asset"] = {{"version", "2.0"}, {"generator", content_.generator}};
        std::set<std::string> used{"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_unlit", "KHR_materials_emissive_strength",
                                   "KHR_materials_ior"};
        for (const shading::MaterialNumber& number : shading::kMaterialNumbers)
            if (const auto name = shading::extension_of(number.gltf); !name.empty()) used.emplace(name);
        root_["extensionsUsed"] = used;
        for (const GlbPicture& picture : content_.pictures) {
            const std::vector<std::uint8_t> rgba8(picture.rgba8.begin(), picture.rgba8.end());
            const auto png = encode_image({picture.width, picture.height, rgba8, {}}, OutputFormat::png);
            if (!png) return tl::unexpected<Error>(png.error());
            root_["images"].push_back({{"bufferView", view(png->data(), png->size())}, {"mimeType", "image/png"}});
        }
        for (const Material& m : scene_.materials) root_["materials"].push_back(material(m));
        for (const Mesh& m : scene_.meshes) root_["meshes"].push_back({{"primitives", {primitive(m)}}});
        for (const Instance& i : scene_.instances) node({{"mesh", i.mesh}, {"matrix", matrix(i.world_from_object)}});
        for (const Light& l : scene_.lights)
            if (!is_sun(l)) light(l);
        camera();
        root_["scene"] = 0;
        root_["scenes"] = {{{"nodes", nodes_}}};
        root_["buffers"] = {{{"byteLength", bin_.size()}}};
        std::string json = root_.dump(), out = "glTF";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        put(out, 2), put(out, static_cast<std::uint32_t>(28 + json.size() + bin_.size()));
        put(out, static_cast<std::uint32_t>(json.size())), out += "JSON" + json;
        put(out, static_cast<std::uint32_t>(bin_.size())), out += std::string("BIN\0", 4) + bin_;
        return out;
    }

private:
    static void put(std::string& out, std::uint32_t value) { out.append(reinterpret_cast<const char*>(&value), 4); }
    [[nodiscard]] bool is_sun(const Light& light) const {
        if (scene_.environment == nullptr) return false;
        const auto suns = environment_suns(*scene_.environment);
        return std::find(suns.begin(), suns.end(), light) != suns.end();
    }
    static Json matrix(const Mat4& m) {
        Json out;
        for (const Vec4f& c : m.c)
            for (const float v : {c.x, c.y, c.z, c.w}) out.push_back(v);
        return out;
    }
    int view(const void* data, std::size_t size) {
        bin_.resize((bin_.size() + 3) / 4 * 4, '\0');
        root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}});
        bin_.append(static_cast<const char*>(data), size);
        bin_.resize((bin_.size() + 3) / 4 * 4, '\0');
        return static_cast<int>(root_["bufferViews"].size()) - 1;
    }
    template <class T>
    int accessor(const std::vector<T>& values, const char* type, int component, std::size_t count) {
        root_["accessors"].push_back({{"bufferView", view(values.data(), values.size() * sizeof(T))},
                                      {"componentType", component},
                                      {"count", count},
                                      {"type", type}});
        return static_cast<int>(root_["accessors"].size()) - 1;
    }
    Json primitive(const Mesh& mesh) {
        Json at;
        at["POSITION"] = accessor(mesh.positions, "VEC3", kFloat, mesh.positions.size());
        Vec3f low = mesh.positions[0], high = low;
        for (const Vec3f& p : mesh.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        root_["accessors"].back()["min"] = {low.x, low.y, low.z};
        root_["accessors"].back()["max"] = {high.x, high.y, high.z};
        if (!mesh.normals.empty()) at["NORMAL"] = accessor(mesh.normals, "VEC3", kFloat, mesh.normals.size());
        if (!mesh.tangents.empty()) at["TANGENT"] = accessor(mesh.tangents, "VEC4", kFloat, mesh.tangents.size());
        if (!mesh.uv0.empty()) at["TEXCOORD_0"] = accessor(mesh.uv0, "VEC2", kFloat, mesh.uv0.size());
        if (!mesh.uv1.empty()) at["TEXCOORD_1"] = accessor(mesh.uv1, "VEC2", kFloat, mesh.uv1.size());
        if (!mesh.colors.empty()) at["COLOR_0"] = accessor(mesh.colors, "VEC4", kFloat, mesh.colors.size());
        return {
            {"attributes", at}, {"indices", accessor(mesh.indices, "SCALAR", kUnsigned, mesh.indices.size())}, {"material", mesh.material}};
    }
    Json texture(const TextureUse& use) {
        constexpr int kWraps[] = {10497, 33648, 33071};
        const int min = use.sampler.mip == MipFilter::none ? 9729 : 9987;
        root_["samplers"].push_back({{"wrapS", kWraps[static_cast<int>(use.sampler.wrap_u)]},
                                     {"wrapT", kWraps[static_cast<int>(use.sampler.wrap_v)]},
                                     {"minFilter", min},
                                     {"magFilter", 9729}});
        root_["textures"].push_back({{"source", use.texture}, {"sampler", root_["samplers"].size() - 1}});
        Json out = {{"index", root_["textures"].size() - 1}, {"texCoord", use.uv_set}};
        // KHR_texture_transform scales, then turns: it has no shear. Rows of another form are kept by their lengths and row_u's angle.
        const double su = std::hypot(use.row_u.x, use.row_v.x), sv = std::hypot(use.row_u.y, use.row_v.y);
        out["extensions"]["KHR_texture_transform"] = {
            {"offset", {use.row_u.z, use.row_v.z}}, {"scale", {su, sv}}, {"rotation", std::atan2(-use.row_v.x, use.row_u.x)}};
        return out;
    }
    static Json::json_pointer pointer_to(std::string_view gltf) { return Json::json_pointer(std::string("/").append(gltf)); }
    static Json& at(Json& of, std::string_view gltf) { return of[pointer_to(gltf)]; }
    Json material(const Material& m) {
        Json out;
        const Material usual;
        for (const TextureSlot slot : shading::kAllTextureSlots)
            if (m.textures[slot].used()) at(out, shading::info_of(slot).gltf) = texture(m.textures[slot]);
        for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
            float values[4], otherwise[4];
            number.get(m, values);
            number.get(usual, otherwise);
            if (number.gltf.empty() || std::equal(values, values + number.count, otherwise)) continue;
            const std::string_view place = number.gltf.substr(0, number.gltf.rfind('/'));
            if (place.ends_with("Texture") && !out.contains(pointer_to(place))) continue;
            at(out, number.gltf) = number.count == 1 ? Json(values[0]) : Json(std::vector<float>(values, values + number.count));
        }
        const float glow = std::max({m.emissive.x, m.emissive.y, m.emissive.z});
        if (glow > 0) {
            out["emissiveFactor"] = {m.emissive.x / glow, m.emissive.y / glow, m.emissive.z / glow};
            out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", glow}};
        }
        if (m.dielectric_reflectance != 0.04f) {
            const double root = std::sqrt(double{m.dielectric_reflectance});
            out["extensions"]["KHR_materials_ior"] = {{"ior", root < 1 ? (1 + root) / (1 - root) : 0.0}};
        }
        out["doubleSided"] = m.double_sided;
        if (m.alpha_mode == AlphaMode::mask) out["alphaMode"] = "MASK";
        if (m.alpha_mode == AlphaMode::blend) out["alphaMode"] = "BLEND";
        if (m.unlit) out["extensions"]["KHR_materials_unlit"] = Json::object();
        out["extras"]["halflit"] = {{"lobe", "mcauley"}, {"wrap", m.lobe.wrap}, {"power", m.lobe.power}, {"normalize", m.lobe.normalize}};
        return out;
    }
    void node(Json n) {
        nodes_.push_back(root_["nodes"].size());
        root_["nodes"].push_back(std::move(n));
    }
    void light(const Light& l) {
        constexpr const char* kTypes[] = {"directional", "point", "spot"};
        const double most = std::max({l.color_linear.x, l.color_linear.y, l.color_linear.z, 1e-30f});
        Json out = {{"type", kTypes[static_cast<int>(l.type)]},
                    {"intensity", most * double{kPi}},
                    {"color", {l.color_linear.x / most, l.color_linear.y / most, l.color_linear.z / most}}};
        if (l.range > 0 && l.type != LightType::directional) out["range"] = l.range;
        if (l.type == LightType::spot) out["spot"] = {{"innerConeAngle", l.inner_cone_rad}, {"outerConeAngle", l.outer_cone_rad}};
        Json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(out);
        const Vec3f travel = normalize_or(l.direction_ws, {0, -1, 0});
        Mat4 place = camera_at({0, 0, 0}, travel).world_from_camera;
        place.c[3] = {l.position_ws.x, l.position_ws.y, l.position_ws.z, 1};
        node({{"matrix", matrix(place)}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
    }
    void camera() {
        const Camera& c = content_.camera;
        const double aspect = content_.aspect;
        if (c.orthographic)
            root_["cameras"] = {
                {{"type", "orthographic"},
                 {"orthographic", {{"xmag", c.half_height * aspect}, {"ymag", c.half_height}, {"znear", c.near_z}, {"zfar", c.far_z}}}}};
        else
            root_["cameras"] = {
                {{"type", "perspective"}, {"perspective", {{"yfov", c.fov_y_rad}, {"znear", c.near_z}, {"aspectRatio", aspect}}}}};
        node({{"camera", 0}, {"matrix", matrix(c.world_from_camera)}});
    }

    const GlbContent& content_;
    const Scene& scene_;
    Json root_, nodes_ = Json::array();
    std::string bin_;
};

}  // namespace

Result<std::string> glb_of(const GlbContent& content) { return Writer(content).file(); }

Result<void> write_file(const std::string& path, const void* data, std::size_t size) {
    std::ofstream out(path, std::ios::binary);
    out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    if (!out) return fail(ErrorCode::io, path + ": cannot be written");
    return {};
}

}  // namespace halflit::test
