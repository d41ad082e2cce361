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

FixedLightTerms on_material(FixedLightTerms terms, const FixedMaterial& material) {
    const float color[3] = {material.color.x, material.color.y, material.color.z};
    for (int k = 0; k < 3; ++k) {
        terms.ambient[k] *= color[k];
        terms.diffuse[k] *= color[k];
        terms.specular[k] *= material.specular;
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

void VertexLight::fill(const FixedItem& item, const VertexRecordArgs& args, const RasterKernels& kernels, int in_turn, int count) const {
    alignas(64) float raw[kMostVertices * 12];
    alignas(64) float lit[kMostVertices * 16];
    VertexRecordArgs of_mesh = args;
    of_mesh.slots = shading::kBaseSlots | (item.material.unlit ? shading::kColorSlot : 0u);
    of_mesh.stride = item.material.unlit ? 12 : 8;
    of_mesh.records = raw - args.begin * of_mesh.stride;
    kernels.vertex_records(of_mesh);

    FixedMaterial material = item.material;
    material.color = {material.color.x * reflectance_, material.color.y * reflectance_, material.color.z * reflectance_, material.color.w};
    FixedVertexArgs light{};
    light.raw = raw;
    light.raw_stride = of_mesh.stride;
    light.count = static_cast<int>(args.end - args.begin);
    light.stride = args.stride;
    light.out = lit;
    put(eye_ws_, light.eye);
    light.shininess = material.shininess;
    light.unlit = material.unlit;
    const Vec3f emitted = material.emission * reflectance_;
    const float color[3] = {material.color.x, material.color.y, material.color.z}, own[3] = {emitted.x, emitted.y, emitted.z};
    for (int k = 0; k < 3; ++k) light.color[k] = material.unlit ? color[k] : own[k] + frame_.ambient * color[k];
    light.color[3] = material.color.w;
    std::vector<FixedLightTerms> terms;
    if (in_turn >= 0) {
        light.separate = true;
        // Solid items without light have their color again in the pass of each light, as far as it is not in shadow.
        for (int k = 0; k < 3; ++k) light.color[k] = material.unlit && item.stage == FixedStage::solid ? color[k] : 0.0f;
        if (material.unlit || item.stage != FixedStage::solid) material.color = {0, 0, 0, 0}, material.specular = 0.0f;
        for (int i = in_turn; i < in_turn + count; ++i)
            terms.push_back(on_material(lights_[shadowed_[static_cast<std::size_t>(i)]], material));
    } else {
        if (!material.unlit)
            for (const std::size_t i : item.stage == FixedStage::solid ? plain_ : all_) terms.push_back(on_material(lights_[i], material));
        std::copy(std::begin(depth_row_), std::end(depth_row_), light.depth);
        light.generated = material.generated && material.texture >= 0;
        if (light.generated) rows_in_world(item, light.planes);
        light.textured = textured_;
        std::copy(std::begin(w_row_), std::end(w_row_), light.clip_w);
    }
    light.lights = terms.data();
    light.light_count = static_cast<int>(terms.size());
    kernels.fixed_vertices(light);
    std::memcpy(args.records + args.begin * args.stride, lit, sizeof(float) * static_cast<std::size_t>(light.count * args.stride));
}

}  // namespace halflit::raster
