#include "raster/passes/geometry.hpp"

#include "raster/passes/scene_facts.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace halflit::raster {
namespace {

constexpr std::int64_t kVerticesPerTask = 64 * kVertexGroup;

/// a * b with each entry summed in double and rounded once, so that large offsets which cancel keep their low bits.
Mat4 multiply_in_double(const Mat4& a, const Mat4& b) {
    Mat4 out;
    const Vec4f* ac = a.c;
    for (int j = 0; j < 4; ++j) {
        const Vec4f v = b.c[j];
        const auto row = [&](float x0, float x1, float x2, float x3) {
            return static_cast<float>(((static_cast<double>(x0) * v.x + static_cast<double>(x1) * v.y) + static_cast<double>(x2) * v.z) +
                                      static_cast<double>(x3) * v.w);
        };
        out.c[j] = {row(ac[0].x, ac[1].x, ac[2].x, ac[3].x), row(ac[0].y, ac[1].y, ac[2].y, ac[3].y),
                    row(ac[0].z, ac[1].z, ac[2].z, ac[3].z), row(ac[0].w, ac[1].w, ac[2].w, ac[3].w)};
    }
    return out;
}

bool finite(const Mat4& m) {
    for (const Vec4f& c : m.c)
        for (const float e : {c.x, c.y, c.z, c.w})
            if (!(e > -3e38f && e < 3e38f)) return false;
    return true;
}

shading::SlotMask slots_of(const Mesh& mesh) {
    shading::SlotMask slots = 1u | 2u;
    if (!mesh.tangents.empty()) slots |= 4u;
    if (!mesh.colors.empty()) slots |= 8u;
    if (!mesh.uv1.empty()) slots |= 16u;
    return slots;
}

Result<void> check_mesh(const Mesh& mesh, std::size_t index, std::size_t material_count) {
    const auto bad = [&](const char* what) { return fail(ErrorCode::bad_input, "mesh " + std::to_string(index) + ": " + what); };
    const std::size_t n = mesh.positions.size();
    if (mesh.indices.size() % 3 != 0) return bad("the number of indices is not a multiple of three");
    const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
    if (!fits(mesh.normals.size()) || !fits(mesh.tangents.size()) || !fits(mesh.uv0.size()) || !fits(mesh.uv1.size()) ||
        !fits(mesh.colors.size()))
        return bad("an attribute array is not as long as the positions");
    if (mesh.material >= 0 && static_cast<std::size_t>(mesh.material) >= material_count) return bad("the material index is out of range");
    std::uint32_t largest = 0;
    for (const std::uint32_t i : mesh.indices) largest = std::max(largest, i);
    if (!mesh.indices.empty() && largest >= n) return bad("an index is not below the number of vertices");
    return {};
}

SamplePattern sample_pattern(int samples) {
    // Rotated grids in sixteenths of a pixel, the positions that graphics hardware made standard.
    static constexpr std::int8_t k4[4][2] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
    static constexpr std::int8_t k8[8][2] = {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
    SamplePattern p;
    p.count = samples;
    for (int s = 0; s < samples && samples > 1; ++s) {
        p.x[s] = static_cast<std::int16_t>(16 * (samples == 4 ? k4[s][0] : k8[s][0]));
        p.y[s] = static_cast<std::int16_t>(16 * (samples == 4 ? k4[s][1] : k8[s][1]));
    }
    return p;
}

Result<void> check_material(const shading::Material& material, std::size_t index, std::size_t texture_count) {
    for (const shading::TextureUse* use : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                                           &material.occlusion_texture, &material.emissive_texture})
        if (use->used() && static_cast<std::size_t>(use->texture) >= texture_count)
            return fail(ErrorCode::bad_input, "material " + std::to_string(index) + ": texture " + std::to_string(use->texture) + " of " +
                                                  std::to_string(texture_count));
    if (const auto lobe = shading::check_lobe(material.lobe); !lobe)
        return fail(lobe.error().code, "material " + std::to_string(index) + ": lobe: " + lobe.error().message);
    return {};
}

Result<void> check_target(const Settings& settings, const FramebufferView& target) {
    if (target.width < 1 || target.height < 1) return fail(ErrorCode::usage, "the picture has no pixels");
    if (target.width > 2 * kGuardBandPx || target.height > 2 * kGuardBandPx)
        return fail(ErrorCode::limit, "a picture of " + std::to_string(target.width) + " x " + std::to_string(target.height) +
                                          " pixels, at most " + std::to_string(2 * kGuardBandPx) + " on a side are supported");
    if (settings.samples != 1 && settings.samples != 4 && settings.samples != 8)
        return fail(ErrorCode::usage, "samples: " + std::to_string(settings.samples) + ", expected 1, 4 or 8");
    if (settings.tile_size != 16 && settings.tile_size != 32 && settings.tile_size != 64)
        return fail(ErrorCode::usage, "tile size: " + std::to_string(settings.tile_size) + ", expected 16, 32 or 64");
    if (!(settings.exposure > 0.0f && settings.exposure < 3e38f)) return fail(ErrorCode::usage, "the exposure is not a positive number");
    if (const auto lobe = shading::check_lobe(settings.shading.lobe); settings.shading.override_lobe && !lobe)
        return fail(ErrorCode::usage, "lobe: " + lobe.error().message);
    const Region& r = settings.region;
    if (r.width != 0 &&
        (r.x < 0 || r.y < 0 || r.width < 1 || r.height < 1 || r.width > target.width - r.x || r.height > target.height - r.y))
        return fail(ErrorCode::usage, "the region is not inside the picture");
    return {};
}

void add_draws(Frame& frame, const Scene& scene, const Mat4& clip_from_world_matrix) {
    const int default_material = static_cast<int>(scene.materials.size());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (mesh.indices.empty()) continue;
        Draw draw;
        draw.mesh = &mesh;
        draw.material = mesh.material >= 0 ? mesh.material : default_material;
        draw.world_from_object = instance.world_from_object;
        draw.clip_from_object = multiply_in_double(clip_from_world_matrix, instance.world_from_object);
        draw.mirrored = determinant3(instance.world_from_object) < 0.0;
        const shading::MaterialPlan& plan = frame.plan.materials[static_cast<std::size_t>(draw.material)];
        draw.cull_back =
            !frame.depth_only && (mesh.material < 0 || !scene.materials[static_cast<std::size_t>(mesh.material)].double_sided);
        draw.mask = plan.alpha_mode == shading::AlphaMode::mask;
        draw.blend = plan.alpha_mode == shading::AlphaMode::blend;
        draw.stride = 4 * std::popcount(plan.slots);
        draw.vertex_base = frame.vertex_count;
        draw.triangle_base = frame.triangle_count;
        draw.record_base = frame.record_floats;
        // Groups of vertices belong to one draw.
        const std::int64_t vertices = (static_cast<std::int64_t>(mesh.positions.size()) + kVertexGroup - 1) / kVertexGroup * kVertexGroup;
        frame.vertex_count += vertices;
        frame.triangle_count += static_cast<std::int64_t>(mesh.indices.size() / 3);
        frame.record_floats += vertices * draw.stride;
        frame.has_mask |= draw.mask;
        frame.has_blend |= draw.blend;
        frame.draws.push_back(draw);
    }
}

/// Calls f(draw, begin, end) for runs of vertices, in parallel; begin and end count from the draw's first vertex.
template <class Function>
void for_vertex_runs(const Frame& frame, Executor& executor, const Function& f) {
    struct Run {
        const Draw* draw;
        std::int64_t begin;
    };
    std::vector<Run> runs;
    for (const Draw& draw : frame.draws)
        for (std::int64_t v = 0; v < static_cast<std::int64_t>(draw.mesh->positions.size()); v += kVerticesPerTask)
            runs.push_back({&draw, v});
    executor.run(static_cast<int>(runs.size()), [&](int i) {
        const Run& run = runs[static_cast<std::size_t>(i)];
        f(*run.draw, run.begin, std::min(run.begin + kVerticesPerTask, static_cast<std::int64_t>(run.draw->mesh->positions.size())));
    });
}

const float* floats(const std::vector<Vec2f>& v) { return v.empty() ? nullptr : &v[0].x; }
const float* floats(const std::vector<Vec3f>& v) { return v.empty() ? nullptr : &v[0].x; }
const float* floats(const std::vector<Vec4f>& v) { return v.empty() ? nullptr : &v[0].x; }

VertexRecordArgs record_args(const Frame& frame, const Draw& draw, float* records) {
    const Mesh& mesh = *draw.mesh;
    VertexRecordArgs args{};
    args.positions = floats(mesh.positions);
    args.normals = floats(mesh.normals);
    args.tangents = floats(mesh.tangents);
    args.uv0 = floats(mesh.uv0);
    args.uv1 = floats(mesh.uv1);
    args.colors = floats(mesh.colors);
    args.slots = frame.plan.materials[static_cast<std::size_t>(draw.material)].slots;
    std::memcpy(args.world_from_object, draw.world_from_object.c, sizeof args.world_from_object);
    const NormalMatrix normal = normal_matrix(draw.world_from_object);
    for (int j = 0; j < 3; ++j) {
        args.normal_from_object[4 * j] = normal.c[j].x;
        args.normal_from_object[4 * j + 1] = normal.c[j].y;
        args.normal_from_object[4 * j + 2] = normal.c[j].z;
        args.normal_from_object[4 * j + 3] = 0.0f;
    }
    args.tangent_sign = draw.mirrored ? -1.0f : 1.0f;
    args.stride = draw.stride;
    args.records = records + draw.record_base;
    return args;
}

}  // namespace

Result<void> prepare_frame(Frame& frame, const Scene& scene, const Camera& camera, const Settings& settings,
                           const FramebufferView& target) {
    if (auto ok = check_target(settings, target); !ok) return ok;
    if (!settings.isa) return tl::unexpected<Error>(settings.isa.error());
    if (!shading::isa_available(*settings.isa))
        return fail(ErrorCode::usage, "this CPU does not run the instruction set " + std::string(shading::isa_name(*settings.isa)));
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        if (auto ok = check_mesh(scene.meshes[i], i, scene.materials.size()); !ok) return ok;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (auto ok = check_material(scene.materials[i], i, scene.textures.size()); !ok) return ok;
    for (const Instance& instance : scene.instances)
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size())
            return fail(ErrorCode::bad_input,
                        "an instance names mesh " + std::to_string(instance.mesh) + " of " + std::to_string(scene.meshes.size()));

    frame.scene = &scene;
    frame.settings = &settings;
    frame.target = target;
    frame.region = settings.region.width != 0 ? settings.region : Region{0, 0, target.width, target.height};
    frame.tile_size = settings.tile_size;
    frame.tiles_x = (frame.region.width + frame.tile_size - 1) / frame.tile_size;
    frame.tiles_y = (frame.region.height + frame.tile_size - 1) / frame.tile_size;
    frame.pattern = sample_pattern(settings.samples);
    frame.viewport.half_width = static_cast<float>(target.width) * 0.5f;
    frame.viewport.half_height = static_cast<float>(target.height) * 0.5f;
    frame.viewport.guard_x = static_cast<float>(kGuardBandPx) / frame.viewport.half_width;
    frame.viewport.guard_y = static_cast<float>(kGuardBandPx) / frame.viewport.half_height;
    frame.raster = &raster_kernels(*settings.isa);
    frame.shade = &shading::shade_kernels(*settings.isa);

    std::vector<shading::SlotMask> slots(scene.materials.size() + 1, 1u | 2u);
    for (const Mesh& mesh : scene.meshes)
        slots[mesh.material >= 0 ? static_cast<std::size_t>(mesh.material) : scene.materials.size()] |= slots_of(mesh);
    shading::PlanOptions plan_options = settings.shading;
    plan_options.environment_order.exposure = static_cast<double>(settings.exposure);
    const bool budget = settings.shading.max_error_codes > 0.0 && !frame.depth_only;
    if (budget) plan_options.environment_order.codes = settings.shading.max_error_codes * (0.5 * shading::kEnvironmentShare);
    if (scene.environment != nullptr) frame.environment_plans.use(scene.environment);
    // Depth alone takes no light: what remains of a plan is what an alpha test reads.
    frame.plan = frame.depth_only ? shading::plan_shading(scene.materials, scene.textures, slots, {}, {}, plan_options)
                                  : shading::plan_shading(scene.materials, scene.textures, slots, scene.lights, scene.ambient,
                                                             plan_options, scene.environment != nullptr ? &frame.environment_plans : nullptr);
    const Vec4f back = camera.world_from_camera.c[2], eye = camera.world_from_camera.c[3];
    frame.plan.eye_ws = {eye.x, eye.y, eye.z};
    frame.plan.view_direction_ws = normalize_or({-back.x, -back.y, -back.z}, {0, 0, -1});
    frame.plan.orthographic = camera.orthographic;

    frame.background = {};
    if (settings.background_environment && scene.environment != nullptr && !scene.environment->rgb.empty())
        frame.background = Background(*scene.environment, camera, target.width, target.height, settings.exposure);
    frame.draws.clear();
    frame.vertex_count = frame.triangle_count = frame.record_floats = 0;
    frame.has_mask = frame.has_blend = false;
    const Mat4 clip = clip_from_world(camera, static_cast<float>(target.width) / static_cast<float>(target.height));
    if (!finite(clip)) return fail(ErrorCode::bad_input, "the camera's matrix is not finite");
    add_draws(frame, scene, clip);
    if (budget)
        shading::spend_error_budget(frame.plan, settings.shading.max_error_codes, static_cast<double>(settings.exposure), scene_facts(frame));
    frame.lights.build(frame.plan);
    if (settings.shading.accuracy == shading::Accuracy::reference && !frame.depth_only)
        if (auto ok = frame.reference.build(scene, frame.plan, plan_options, slots); !ok) return ok;
    if (frame.vertex_count >= static_cast<std::int64_t>(kClipVertex)) return fail(ErrorCode::limit, "more than 2^31 vertices");
    if (frame.triangle_count >= (std::int64_t{1} << 28)) return fail(ErrorCode::limit, "more than 2^28 triangles");
    return {};
}

void transform_vertices(Frame& frame, Executor& executor) {
    const auto vertices = static_cast<std::size_t>(frame.vertex_count);
    ScreenVertex* screen = frame.screen.reserve(vertices);
    std::uint8_t* outcodes = frame.outcodes.reserve(vertices);
    std::uint8_t* used = frame.group_used.reserve(vertices / kVertexGroup + 1);
    std::memset(used, 0, vertices / kVertexGroup + 1);
    for_vertex_runs(frame, executor, [&](const Draw& draw, std::int64_t begin, std::int64_t end) {
        TransformArgs args{};
        args.positions = floats(draw.mesh->positions);
        args.begin = begin;
        args.end = end;
        std::memcpy(args.clip_from_object, draw.clip_from_object.c, sizeof args.clip_from_object);
        args.viewport = frame.viewport;
        args.screen = screen + draw.vertex_base;
        args.outcodes = outcodes + draw.vertex_base;
        frame.raster->transform(args);
    });
}

void make_vertex_records(Frame& frame, Executor& executor) {
    float* records = frame.records.reserve(static_cast<std::size_t>(frame.record_floats));
    const std::uint8_t* used = frame.group_used.data();
    frame.draw_records.clear();
    for (const Draw& draw : frame.draws) frame.draw_records.push_back({records + draw.record_base - draw.vertex_base * draw.stride});
    for_vertex_runs(frame, executor, [&](const Draw& draw, std::int64_t begin, std::int64_t end) {
        if (draw.stride == 0) return;
        VertexRecordArgs args = record_args(frame, draw, records);
        for (std::int64_t v = begin; v < end; v += kVertexGroup) {
            if (!used[(draw.vertex_base + v) / kVertexGroup]) continue;
            args.begin = v;
            args.end = std::min(v + kVertexGroup, end);
            frame.raster->vertex_records(args);
        }
    });
}

void make_clip_records(Frame& frame, Executor& executor) {
    frame.clip_records.resize(frame.chunk_count);
    executor.run(static_cast<int>(frame.chunk_count), [&](int i) {
        Chunk& chunk = *frame.chunks[static_cast<std::size_t>(i)];
        chunk.clip_records.resize(chunk.clip_vertices.size() * shading::kVertexFloats);
        for (std::size_t k = 0; k < chunk.clip_vertices.size(); ++k) {
            const ClipVertex& v = chunk.clip_vertices[k];
            const Draw& draw = frame.draws[v.draw];
            const float* base = frame.draw_records[v.draw].base;
            float* out = chunk.clip_records.data() + k * shading::kVertexFloats;
            for (int j = 0; j < draw.stride; ++j)
                out[j] = (base[v.parent[0] * static_cast<std::int64_t>(draw.stride) + j] * v.weight[0] +
                          base[v.parent[1] * static_cast<std::int64_t>(draw.stride) + j] * v.weight[1]) +
                         base[v.parent[2] * static_cast<std::int64_t>(draw.stride) + j] * v.weight[2];
        }
        frame.clip_records[static_cast<std::size_t>(i)] = chunk.clip_records.data();
    });
}

}  // namespace halflit::raster
