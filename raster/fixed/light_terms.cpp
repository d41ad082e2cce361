#include "raster/fixed/light_terms.hpp"

#include "sh/mat4.hpp"
#include "sh/trig.hpp"

#include <algorithm>
#include <cstring>

namespace halflit::raster {
namespace {

constexpr int kMostVertices = 64 + 16;  // a group, and what a whole vector reads beyond it

void put(Vec3f v, float (&out)[3]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
Vec3f unit(Vec3f v) { return normalize_or(v, {0, 0, 0}); }

FixedLightTerms terms_of(const FixedLight& light) {
    FixedLightTerms terms{};
    const Vec3f along = unit(light.direction_ws);
    put(light.directional ? along * -1.0f : light.position_ws, terms.place);
    terms.directional = light.directional;
    put(along, terms.axis);
    terms.cos_cutoff = light.cutoff_deg <= 90.0f ? static_cast<float>(sin_cos(light.cutoff_deg * (kPi / 180.0)).cos) : -2.0f;
    terms.exponent = light.exponent;
    std::copy(std::begin(light.attenuation), std::end(light.attenuation), terms.attenuation);
    put(light.ambient, terms.ambient);
    put(light.diffuse, terms.diffuse);
    put(light.specular, terms.specular);
    return terms;
}

void put_rgb(Vec3f v, float (&out)[4]) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

FixedLightTerms on_material(FixedLightTerms terms, Vec3f color, float specular) {
    const float rgb[3] = {color.x, color.y, color.z};
    for (int k = 0; k < 3; ++k) {
        terms.ambient[k] *= rgb[k];
        terms.diffuse[k] *= rgb[k];
        terms.specular[k] *= specular;
    }
    return terms;
}

/// Rows for positions in the world from rows for positions of the object.
void rows_in_world(const FixedItem& item, float (&out)[3][4]) {
    const Mat4& m = item.world_from_object;
    const Vec3d x = axis(m, 0), y = axis(m, 1), z = axis(m, 2), origin = axis(m, 3);
    const Vec3d inverse[3] = {cross(y, z), cross(z, x), cross(x, y)};  // rows, times the determinant
    const double determinant = dot(x, inverse[0]);
    for (int r = 0; r < 3; ++r) {
        const Vec4f& plane = item.material.planes[r];
        const Vec3d row = (inverse[0] * double{plane.x} + inverse[1] * double{plane.y} + inverse[2] * double{plane.z}) *
                          (determinant != 0.0 ? 1.0 / determinant : 0.0);
        out[r][0] = static_cast<float>(row.x), out[r][1] = static_cast<float>(row.y), out[r][2] = static_cast<float>(row.z);
        out[r][3] = static_cast<float>(double{plane.w} - dot(row, origin));
    }
}

}  // namespace

VertexLight::VertexLight(const FixedFrame& frame, const Mat4& view_from_world, const Mat4& clip_from_world, Vec3f eye_ws, bool shares,
                         float reflectance)
    : frame_(frame), eye_ws_(eye_ws), reflectance_(reflectance) {
    for (int k = 0; k < 4; ++k) depth_row_[k] = -view_from_world.c[k].z, w_row_[k] = clip_from_world.c[k].w;
    textured_ = std::any_of(frame.items.begin(), frame.items.end(), [](const FixedItem& item) { return item.material.texture >= 0; });
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        lights_.push_back(terms_of(frame.lights[i]));
        all_.push_back(i);
        (shares && frame.lights[i].shadow_size > 0 ? shadowed_ : plain_).push_back(i);
    }
}

shading::SlotMask VertexLight::surface_slots() const {
    return shading::kPositionSlot | shading::kUv0Slot | shading::kTangentSlot | (textured_ ? shading::kUv1Slot : 0u);
}

Vec3f VertexLight::color_of(const FixedMaterial& material) const {
    return Vec3f{material.color.x, material.color.y, material.color.z} * reflectance_;
}

ItemLight VertexLight::of(const FixedItem& item) const {
    ItemLight made;
    FixedVertexArgs& args = made.args;
    put(eye_ws_, args.eye);
    args.shininess = item.material.shininess;
    args.unlit = item.material.unlit;
    args.color[3] = item.material.color.w;
    return made;
}

ItemLight VertexLight::surface_of(const FixedItem& item) const {
    const FixedMaterial& material = item.material;
    ItemLight made = of(item);
    FixedVertexArgs& args = made.args;
    const Vec3f color = color_of(material);
    put_rgb(material.unlit ? color : material.emission * reflectance_ + color * frame_.ambient, args.color);
    if (!material.unlit)
        for (const std::size_t i : item.stage == FixedStage::solid ? plain_ : all_)
            made.terms.push_back(on_material(lights_[i], color, material.specular));
    std::copy(std::begin(depth_row_), std::end(depth_row_), args.depth);
    args.generated = material.generated && material.texture >= 0;
    args.uv_scale[0] = material.uv_scale.x, args.uv_scale[1] = material.uv_scale.y;
    if (args.generated) rows_in_world(item, args.planes);
    args.textured = textured_;
    std::copy(std::begin(w_row_), std::end(w_row_), args.clip_w);
    return made;
}

ItemLight VertexLight::shadowed_of(const FixedItem& item, int first, int count) const {
    ItemLight made = of(item);
    made.args.separate = true;
    Vec3f color = color_of(item.material);
    float specular = item.material.specular;
    const bool is_solid = item.stage == FixedStage::solid;
    // Solid items without light have their color again in the pass of each light, as far as it is not in shadow.
    if (item.material.unlit && is_solid) put_rgb(color, made.args.color);
    if (item.material.unlit || !is_solid) color = {0, 0, 0}, specular = 0.0f;
    for (int i = first; i < first + count; ++i)
        made.terms.push_back(on_material(lights_[shadowed_[static_cast<std::size_t>(i)]], color, specular));
    return made;
}

void ItemLight::fill(const VertexRecordArgs& to, const RasterKernels& kernels) const {
    alignas(64) float raw[kMostVertices * 12];
    alignas(64) float lit[kMostVertices * 16];
    VertexRecordArgs of_mesh = to;
    of_mesh.slots = shading::kBaseSlots | (args.unlit ? shading::kColorSlot : 0u);
    of_mesh.stride = args.unlit ? 12 : 8;
    of_mesh.records = raw - to.begin * of_mesh.stride;
    kernels.vertex_records(of_mesh);
    FixedVertexArgs light = args;
    light.raw = raw;
    light.raw_stride = of_mesh.stride;
    light.count = static_cast<int>(to.end - to.begin);
    light.out = lit;
    light.stride = to.stride;
    light.lights = terms.data();
    light.light_count = static_cast<int>(terms.size());
    kernels.fixed_vertices(light);
    std::memcpy(to.records + to.begin * to.stride, lit, sizeof(float) * static_cast<std::size_t>(light.count * to.stride));
}

}  // namespace halflit::raster
