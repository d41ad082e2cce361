// Actions of the schema: each takes a value into the file, or says what is wrong with it.
#pragma once

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/file/filler.hpp"
#include "apps/io/gltf/file/schema.hpp"
#include "halflit/light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail::actions {

using file::File;
using F = GltfFiller&;
using V = const JsonValue&;

[[noreturn]] inline void fault(V value, std::string what) { throw JsonFault{ErrorCode::bad_input, value.offset, std::move(what)}; }

inline void assign(F, int& out, V value) { out = static_cast<int>(value.number); }
inline void assign(F, std::uint64_t& out, V value) { out = static_cast<std::uint64_t>(value.number); }
inline void assign(F, double& out, V value) { out = value.number; }
inline void assign(F, bool& out, V value) { out = value.truth; }
inline void assign(F f, std::string_view& out, V value) { out = f.keep(value); }
inline void assign(F f, std::optional<std::string_view>& out, V value) { out = f.keep(value); }
template <class T>
void assign(F f, std::vector<T>& out, V value) {
    assign(f, f.append(out), value);
}

/// Appends an element to a list of the file.
template <auto List>
void add(F f, V) {
    f.append(f.file.*List);
}

/// Stores a value in a member of the list's last element; a member that is a list itself has it appended.
template <auto List, auto Member>
void put(F f, V value) {
    assign(f, (f.file.*List).back().*Member, value);
}

template <auto Member>
void put_file(F f, V value) {
    assign(f, f.file.*Member, value);
}

template <auto Member>
void put_sparse(F f, V value) {
    assign(f, f.file.sparse.back().*Member, value);
}

template <auto Member>
void put_primitive(F f, V value) {
    assign(f, f.file.meshes.back().primitives.back().*Member, value);
}

/// Appends a number to the transform of the node that is being read.
template <auto Member>
void put_transform(F f, V value) {
    (f.*Member).push_back(value.number);
}

/// Appends an entry to an array of the file and to the node's run of it.
template <auto Array, auto Member>
void put_run(F f, V value) {
    assign(f, f.append(f.file.*Array), value);
    file::Run& run = f.file.nodes.back().*Member;
    if (run.count++ == 0) run.first = static_cast<std::uint32_t>((f.file.*Array).size() - 1);
}

template <auto Which, auto Member>
void put_projection(F f, V value) {
    assign(f, (*(f.file.cameras.back().*Which)).*Member, value);
}

template <auto Member>
void put_perspective(F f, V value) {
    put_projection<&file::Camera::perspective, Member>(f, value);
}

template <auto Member>
void put_orthographic(F f, V value) {
    put_projection<&file::Camera::orthographic, Member>(f, value);
}

template <auto Member>
void put_light(F f, V value) {
    put<&File::lights, Member>(f, value);
}

template <auto Member>
void put_sampler(F f, V value) {
    put<&File::samplers, Member>(f, value);
}

template <auto Which>
void begin_projection(F f, V value) {
    (f.file.cameras.back().*Which).emplace();
    (Which == &file::Camera::perspective ? f.perspective_offset : f.orthographic_offset) = value.offset;
}

template <auto Member>
void put_magnification(F f, V value) {
    (*f.file.cameras.back().orthographic).*Member = value.number;
    if (value.number == 0) f.warn(value.offset, "expected a number other than 0", "the camera is left out");
}

template <auto Which>
void put_zfar(F f, V value) {
    (*(f.file.cameras.back().*Which)).zfar = value.number;
    (Which == &file::Camera::perspective ? f.perspective_zfar : f.orthographic_zfar) = value.offset;
}

template <std::size_t Slot>
void begin_place(F f, V) {
    f.place = &f.file.materials.back().places[Slot];
}

/// A number of the material that is being read, or one of a few.
template <std::size_t Row>
void put_material_number(F f, V value) {
    constexpr auto kCount = static_cast<std::size_t>(shading::kMaterialNumbers[Row].count);
    const std::size_t at = kCount == 1 ? 0 : f.component;
    if (at < kCount) f.file.materials.back().numbers[shading::kFirstFloats[Row] + at] = value.number;
}

/// Specular and glossiness of the material that is being read.
inline file::SpecularGlossiness& glossy(F f) {
    file::Material& material = f.file.materials.back();
    if (material.glossy < 0) {
        f.append(f.file.glossy);
        material.glossy = static_cast<int>(f.file.glossy.size() - 1);
    }
    return f.file.glossy.back();
}

template <auto Member>
void put_glossy(F f, V value) {
    assign(f, glossy(f).*Member, value);
}

template <auto Member>
void begin_glossy_place(F f, V) {
    f.place = &(glossy(f).*Member);
}

template <auto Member>
void put_place(F f, V value) {
    assign(f, f.place->*Member, value);
}

inline void begin_texture_transform(F f, V) {
    f.append(f.file.texture_transforms);
    f.place->transform = static_cast<int>(f.file.texture_transforms.size() - 1);
}

template <auto Member>
void put_texture_transform(F f, V value) {
    assign(f, f.file.texture_transforms.back().*Member, value);
}

template <auto Member>
void put_own_lobe(F f, V value) {
    (*f.file.materials.back().own_lobe).parameters.*Member = static_cast<float>(value.number);
}

inline void put_version(F f, V value) {
    if (value.type == JsonType::string)
        f.file.version = f.keep(value);
    else if (value.number >= 1 && value.number < 2)
        f.file.version = "1.0";  // some of these have a number; refused
    else
        fault(value, fmt::format("expected a string, found {}", name_of(value.type)));
}

inline void put_generator(F f, V value) {
    if (value.type == JsonType::string) f.file.generator = f.keep(value);
}

inline void put_byte_stride(F f, V value) {
    const int stride = static_cast<int>(value.number);
    if (stride < 4 || stride > 252 || stride % 4 != 0)
        fault(value, fmt::format("expected a multiple of 4 from 4 to 252, found {}", stride));
    f.file.buffer_views.back().byte_stride = stride;
}

inline void begin_compressed(F f, V) {
    f.append(f.file.compressed_views);
    f.file.buffer_views.back().compressed = static_cast<int>(f.file.compressed_views.size() - 1);
}

template <auto Member>
void put_compressed(F f, V value) {
    assign(f, f.file.compressed_views.back().*Member, value);
}

inline void put_compression_mode(F f, V value) {
    file::CompressionMode& mode = f.file.compressed_views.back().mode;
    if (value.text == "ATTRIBUTES")
        mode = file::CompressionMode::attributes;
    else if (value.text == "TRIANGLES")
        mode = file::CompressionMode::triangles;
    else if (value.text == "INDICES")
        mode = file::CompressionMode::indices;
    else
        fault(value, fmt::format("expected ATTRIBUTES, TRIANGLES or INDICES, found \"{}\"", printable(value.text, 40)));
}

inline void put_compression_filter(F f, V value) {
    static constexpr std::string_view kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
    const auto* found = std::find(std::begin(kFilters), std::end(kFilters), value.text);
    if (found == std::end(kFilters))
        fault(value, fmt::format("expected NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR, found \"{}\"", printable(value.text, 40)));
    f.file.compressed_views.back().filter = static_cast<file::CompressionFilter>(found - std::begin(kFilters));
}

inline void put_accessor_type(F f, V value) {
    static constexpr std::pair<std::string_view, int> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                  {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, components] : kTypes)
        if (value.text == name) {
            f.file.accessors.back().components = components;
            return;
        }
    fault(value, fmt::format("expected SCALAR, VEC2 to VEC4 or MAT2 to MAT4, found \"{}\"", printable(value.text, 40)));
}

inline void begin_sparse(F f, V) {
    f.append(f.file.sparse);
    f.file.accessors.back().sparse = static_cast<int>(f.file.sparse.size() - 1);
}

inline void add_primitive(F f, V) {
    ++f.file.primitives;
    f.append(f.file.meshes.back().primitives);
}

inline void put_attribute(F f, V value) {
    f.append(f.file.meshes.back().primitives.back().attributes, {f.key, static_cast<int>(value.number)});
}

inline void add_variant_material(F f, V) { f.append(f.file.meshes.back().primitives.back().variants); }

template <auto Member>
void put_variant_material(F f, V value) {
    assign(f, f.file.meshes.back().primitives.back().variants.back().*Member, value);
}

inline void put_splat_colors(F f, V value) { f.file.meshes.back().primitives.back().linear_splats = value.text == "lin_rec709_display"; }

inline void begin_draco(F f, V) {
    f.append(f.file.draco);
    f.file.meshes.back().primitives.back().draco = static_cast<int>(f.file.draco.size() - 1);
}

inline void put_draco_view(F f, V value) { assign(f, f.file.draco.back().buffer_view, value); }

inline void put_draco_attribute(F f, V value) { f.append(f.file.draco.back().attributes, {f.key, static_cast<int>(value.number)}); }

inline void add_morph_target(F f, V) {
    ++f.file.morph_targets;
    f.append(f.file.meshes.back().primitives.back().targets);
}

inline void put_morph_attribute(F f, V value) {
    f.append(f.file.meshes.back().primitives.back().targets.back(), {f.key, static_cast<int>(value.number)});
}

/// Rotations are unit quaternions, and matrices products of a translation, a rotation and a scale (glTF 2.0, 3.5.3).
inline void check_transform(F f) {
    if (!f.rotation.empty()) {
        double length2 = 0;
        for (const double q : f.rotation) length2 += q * q;
        constexpr double kTolerance = 0.01;  // of the square; a quaternion of 8-bit integers is wrong by up to 0.008
        if (!(length2 > 1e-200))
            f.warn(f.rotation_offset, "the quaternion has length 0", "drawn without rotation");
        else if (!(length2 > 1 - kTolerance && length2 < 1 + kTolerance))
            f.warn(f.rotation_offset, fmt::format("the quaternion has length {:.4g}, expected 1", std::sqrt(length2)),
                   "drawn as if it were 1");
    }
    if (f.matrix.empty()) return;
    const double* m = f.matrix.data();
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) f.warn(f.matrix_offset, "the last row is not 0 0 0 1", "drawn as if it were");
    const Vec3d columns[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
    constexpr double kShear = 1e-3;  // cosine between two columns; products of rotations that are rounded to three digits stay below
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d a = columns[i], b = columns[(i + 1) % 3];
        const double cosine = dot(a, b), limit = kShear * length(a) * length(b);
        if (cosine > limit || cosine < -limit)
            return f.warn(f.matrix_offset, "is no product of a translation, a rotation and a scale", "drawn with its shear");
    }
}

inline void begin_node(F f, V) {
    f.append(f.file.nodes);
    for (auto* list : {&f.matrix, &f.translation, &f.rotation, &f.scale}) list->clear();
}

inline void end_node(F f, V) {
    // Lists of another length are faults already.
    if (f.matrix.size() != 16) f.matrix.clear();
    if (f.rotation.size() != 4) f.rotation.clear();
    for (auto* list : {&f.translation, &f.scale})
        if (list->size() != 3) list->clear();
    const bool parts = !(f.translation.empty() && f.rotation.empty() && f.scale.empty());
    if (f.matrix.empty() && !parts) return;
    if (!f.matrix.empty() && parts) {
        f.fault(f.matrix_offset, "there are a translation, a rotation or a scale beside it, and they exclude each other");
        f.matrix.clear();
    }
    check_transform(f);
    file::Transform& made = f.append(f.file.transforms);
    if (!f.matrix.empty()) {  // the last row of an affine transform is 0 0 0 1
        made.matrix.emplace();
        for (std::size_t j = 0; j < 4; ++j) made.matrix->c[j] = {f.matrix[4 * j], f.matrix[4 * j + 1], f.matrix[4 * j + 2]};
    }
    std::copy(f.translation.begin(), f.translation.end(), made.translation);
    std::copy(f.rotation.begin(), f.rotation.end(), made.rotation);
    std::copy(f.scale.begin(), f.scale.end(), made.scale);
    f.file.nodes.back().transform = static_cast<int>(f.file.transforms.size() - 1);
}

inline void put_first_max(F f, V value) {
    if (std::optional<double>& max = f.file.accessors.back().max; !max) max = value.number;
}

inline void add_channel(F f, V) { f.append(f.file.animations.back().channels); }

template <auto Member>
void put_channel(F f, V value) {
    assign(f, f.file.animations.back().channels.back().*Member, value);
}

inline void put_path(F f, V value) {
    static constexpr std::string_view kPaths[] = {"translation", "rotation", "scale", "weights", "pointer"};
    f.file.animations.back().channels.back().path = f.keep(value);
    if (std::find(std::begin(kPaths), std::end(kPaths), value.text) == std::end(kPaths))
        f.warn(value.offset, fmt::format("\"{}\" is unknown", printable(value.text, 40)), "the channel is left out");
}

inline void add_animation_sampler(F f, V) { f.append(f.file.animations.back().samplers); }

template <auto Member>
void put_animation_sampler(F f, V value) {
    assign(f, f.file.animations.back().samplers.back().*Member, value);
}

inline void put_interpolation(F f, V value) {
    file::Interpolation& interpolation = f.file.animations.back().samplers.back().interpolation;
    if (value.text == "STEP")
        interpolation = file::Interpolation::step;
    else if (value.text == "CUBICSPLINE")
        interpolation = file::Interpolation::cubic;
    else if (value.text != "LINEAR")
        f.warn(value.offset, fmt::format("\"{}\" is unknown", printable(value.text, 40)), "read as LINEAR");
}

inline void end_animation(F f, V value) {
    const file::Animation& animation = f.file.animations.back();
    if (animation.channels.empty()) f.warn(value.offset, "it has no channels", "it moves nothing");
    for (std::size_t i = 0; i < animation.channels.size(); ++i)
        if (const int sampler = animation.channels[i].sampler; sampler >= static_cast<int>(animation.samplers.size()))
            fault(value,
                  fmt::format("channels[{}].sampler: index {}, but the animation has {} samplers", i, sampler, animation.samplers.size()));
}

inline void end_camera(F f, V value) {
    const file::Camera& camera = f.file.cameras.back();
    if (camera.type != "perspective" && camera.type != "orthographic") return;  // a fault of its own
    const bool perspective = camera.type == "perspective";
    if (!(perspective ? camera.perspective : camera.orthographic))
        fault(value, fmt::format("expected the key \"{}\", which is not there", camera.type));
    if (perspective ? camera.orthographic : camera.perspective)
        f.warn(perspective ? f.orthographic_offset : f.perspective_offset, fmt::format("the camera's type is {}", camera.type), "ignored");
    const file::Projection& p = perspective ? *camera.perspective : *camera.orthographic;
    if (p.zfar > 0 && !(p.zfar > p.znear))
        f.warn(perspective ? f.perspective_zfar : f.orthographic_zfar,
               fmt::format("expected more than znear, which is {}, found {}", p.znear, p.zfar), "the camera is left out");
}

inline void put_camera_type(F f, V value) {
    f.file.cameras.back().type = f.keep(value);
    if (value.text != "perspective" && value.text != "orthographic")
        fault(value, fmt::format("expected perspective or orthographic, found \"{}\"", printable(value.text, 40)));
}

inline void end_light(F f, V value) {
    const file::Light& light = f.file.lights.back();
    if (light.type == "spot" && !light.has_spot) fault(value, "expected the key \"spot\", which is not there");
    if (light.type == "spot" && !(light.inner_cone_angle < light.outer_cone_angle))
        f.warn(f.spot_offset,
               fmt::format("innerConeAngle is {}, expected less than outerConeAngle, which is {}", light.inner_cone_angle,
                           light.outer_cone_angle),
               "drawn with a hard edge");
}

inline void put_light_type(F f, V value) {
    f.file.lights.back().type = f.keep(value);
    if (!light_type_of(value.text))
        f.warn(value.offset, fmt::format("\"{}\" is unknown", printable(value.text, 40)), "the light is left out");
}

inline void put_alpha_mode(F f, V value) {
    if (value.text == "OPAQUE" || value.text == "MASK" || value.text == "BLEND")
        f.file.materials.back().alpha_mode = f.keep(value);
    else
        f.warn(value.offset, fmt::format("\"{}\" is unknown", printable(value.text, 40)), "drawn as OPAQUE");
}

}  // namespace halflit::io::detail::actions
