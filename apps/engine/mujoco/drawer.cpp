#include "apps/engine/mujoco/drawer.hpp"

#include "sh/available_cores.hpp"
#include "sh/fp_environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>

namespace halflit::engine::mujoco {
namespace {

constexpr double kAlmostAll = 1 - 1e-9;  // of a time limit: 0 means none

/// The digits of a number in a base, mirrored at the point: numbers that follow each other are far apart.
double radical_inverse(std::uint32_t number, std::uint32_t base) {
    double sum = 0, place = 1.0 / base;
    for (; number > 0; number /= base, place /= base) sum += place * (number % base);
    return sum;
}

/// The colour of a segid: its digits, or one that differs from those of its neighbours.
void put_color(std::int32_t segid, bool by_number, std::uint8_t* to) {
    const auto code = static_cast<std::uint32_t>(segid) + 1;
    for (int k = 0; k < 3; ++k) {
        if (by_number)
            to[k] = static_cast<std::uint8_t>(code >> 8 * k);
        else
            to[k] = static_cast<std::uint8_t>(255 * (0.1 + 0.8 * radical_inverse(code + 9, k == 0 ? 2 : k == 1 ? 3 : 5)) + 0.5);
    }
}

/// ids: those of the frame's items, 0 for nothing.
void show_ids(const Picture& picture, const SceneFrame& made, std::span<const std::uint32_t> ids, bool as_colors, bool by_number) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Geom* geom = ids[i] > 0 ? &made.geoms[ids[i] - 1] : nullptr;
        if (picture.segid != nullptr) picture.segid[i] = geom != nullptr ? geom->segid : -1;
        if (picture.object != nullptr) {
            picture.object[2 * i] = geom != nullptr ? geom->objid : -1;
            picture.object[2 * i + 1] = geom != nullptr ? geom->objtype : -1;
        }
        if (as_colors && geom == nullptr)
            std::fill_n(picture.rgb + 3 * i, 3, std::uint8_t{0});
        else if (as_colors)
            put_color(geom->segid, by_number, picture.rgb + 3 * i);
    }
}

/// depth: 1 at the near plane, 0 at the far plane.
void convert_depth(const Picture& picture, const SceneFrame& made, std::size_t pixels) {
    const double near = made.near_z, far = made.far_z, range = far - near;
    const bool parallel = made.frame.camera.parallel;
    for (float* depth = picture.depth; depth < picture.depth + pixels; ++depth) {
        const double d = *depth;
        *depth = static_cast<float>(!picture.depth_is_distance ? 1 - d : parallel ? far - d * range : near * far / (near + d * range));
    }
}

}  // namespace

Result<void> check_size(const Picture& picture) {
    constexpr int kMostSide = 16384;
    if (picture.width < 1 || picture.height < 1 || picture.width > kMostSide || picture.height > kMostSide)
        return fail(ErrorCode::usage,
                    fmt::format("picture: {} x {} pixels, expected 1 to {} on a side", picture.width, picture.height, kMostSide));
    if (picture.samples != 1 && picture.samples != 4)
        return fail(ErrorCode::usage, fmt::format("picture: samples is {}, expected 1 or 4", picture.samples));
    return {};
}

Drawer::Drawer(FrameModel model, FixedFunctionRenderer renderer, const Execution& execution)
    : model_(std::move(model)), execution_(execution) {
    workers_.push_back(std::make_unique<Worker>(Worker{std::move(renderer), {}, {}, {}}));
}

Result<Drawer> Drawer::make(const Model& model, const Look& look, const Execution& execution) {
    const FpEnvironment environment;
    if (auto ok = check_model(model); !ok) return tl::unexpected<Error>(ok.error());
    auto meshes = make_meshes(model, look.shapes_have_uv);
    if (!meshes) return tl::unexpected<Error>(meshes.error());
    auto textures = make_textures(model, look);
    if (!textures) return tl::unexpected<Error>(textures.error());
    auto frames = frame_model(model, look, *meshes);
    if (!frames) return tl::unexpected<Error>(frames.error());
    auto renderer = FixedFunctionRenderer::make(std::move(meshes->meshes), std::move(*textures), execution);
    if (!renderer) return tl::unexpected<Error>(renderer.error());
    return Drawer(std::move(*frames), std::move(*renderer), execution);
}

Result<void> Drawer::move_vertices(Worker& by, const Scene& scene, const Execution& execution) const {
    const ModelMeshes& numbers = model_.numbers;
    for (std::size_t k = 0; k < numbers.soft.size(); ++k) {
        const SoftMesh& soft = numbers.soft[k];
        const bool is_skin = static_cast<int>(k) < numbers.flexes - numbers.skins;
        const float *positions = is_skin ? scene.skinvert : scene.flexface, *normals = is_skin ? scene.skinnormal : scene.flexnormal;
        if (positions == nullptr || normals == nullptr || soft.count == 0 || (!is_skin && scene.flexfaceused == nullptr)) continue;
        const std::int64_t each = is_skin ? 3 : 9;
        std::int64_t used = soft.count;
        if (!is_skin) {
            const auto flex = k - static_cast<std::size_t>(numbers.flexes - numbers.skins);
            used = scene.flexfaceused[flex];
            if (used < 0 || used > soft.count)
                return fail(ErrorCode::bad_input, fmt::format("flex {}: {} triangles, the model has {}", flex, used, soft.count));
        }
        const auto vertices = static_cast<std::size_t>(soft.count * each / 3);
        const auto take = [&](const float* from, std::vector<Vec3f>& to) {
            to.assign(vertices, {0, 0, 0});  // triangles that are not used have no area
            for (std::size_t v = 0; v < static_cast<std::size_t>(used * each / 3); ++v)
                to[v] = {from[3 * v], from[3 * v + 1], from[3 * v + 2]};
        };
        take(positions + soft.first * each, by.positions);
        take(normals + soft.first * each, by.normals);
        if (auto ok = by.renderer.set_vertices(numbers.skins + static_cast<int>(k), by.positions, by.normals, execution); !ok) return ok;
    }
    return {};
}

Result<void> Drawer::draw(Worker& by, const Picture& picture, const Execution& execution,
                          std::chrono::steady_clock::time_point start) const {
    const FpEnvironment environment;
    const Scene& scene = *picture.scene;
    if (auto ok = check_size(picture); !ok) return ok;
    FrameRequest request{.camera = picture.camera != nullptr ? picture.camera : scene.camera,
                         .flags = picture.flags != nullptr ? picture.flags : scene.flags,
                         .width = picture.width,
                         .height = picture.height};
    if (request.camera == nullptr) return fail(ErrorCode::usage, "picture: the camera is null");
    if ((scene.geoms == nullptr && scene.ngeom != 0) || (scene.lights == nullptr && scene.nlight != 0) || scene.ngeom < 0 ||
        scene.nlight < 0)
        return fail(ErrorCode::usage, fmt::format("scene: {} geoms and {} lights, an array is null", scene.ngeom, scene.nlight));
    const std::uint8_t* flags = request.flags != nullptr ? request.flags : kDefaultFlags;
    const bool colors = picture.rgb != nullptr && flags[kSegment] == 0, as_colors = picture.rgb != nullptr && !colors;
    const bool with_ids = picture.segid != nullptr || picture.object != nullptr || as_colors;
    const bool of_color_pass = picture.depth != nullptr && picture.depth_of_color_pass;
    if (!colors && !with_ids && picture.depth == nullptr) return {};
    const auto rest = [&] {
        Execution left = execution;
        const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (left.time_limit_s > 0) left.time_limit_s -= std::min(passed, left.time_limit_s * kAlmostAll);
        return left;
    };
    if (auto ok = move_vertices(by, scene, rest()); !ok) return ok;
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    if (with_ids) by.ids.resize(pixels);
    // Planes that are not drawn yet. Those of the segmentation pass, and the depth of a picture of one sample, may come with the colors.
    bool depth = picture.depth != nullptr, ids = with_ids;
    const auto pass = [&](Pass of, bool with_rgb) -> Result<void> {
        request.pass = of;
        const auto made = make_frame(model_, scene, request);
        if (!made) return tl::unexpected<Error>(made.error());
        const bool segments = of == Pass::segment || (!of_color_pass && made->has_segments);
        const bool takes_depth = depth && (of_color_pass ? of == Pass::depth || picture.samples == 1 : segments);
        const FixedTarget target{.width = picture.width,
                                 .height = picture.height,
                                 .samples = with_rgb ? picture.samples : 1,
                                 .bottom_up = picture.bottom_up,
                                 .rgb = with_rgb ? picture.rgb : nullptr,
                                 .depth = takes_depth ? picture.depth : nullptr,
                                 .ids = ids && segments ? by.ids.data() : nullptr,
                                 .backdrop_depth = with_rgb && takes_depth && of_color_pass};
        if (auto ok = by.renderer.render(made->frame, target, rest()); !ok) return ok;
        if (target.ids != nullptr) show_ids(picture, *made, by.ids, as_colors, flags[kIdColor] != 0);
        if (takes_depth) convert_depth(picture, *made, pixels);
        depth &= !takes_depth, ids &= !segments;
        return {};
    };
    if (colors)
        if (auto ok = pass(Pass::color, true); !ok) return ok;
    if (depth && of_color_pass)
        if (auto ok = pass(Pass::depth, false); !ok) return ok;
    return depth || ids ? pass(Pass::segment, false) : Result<void>{};
}

Result<void> Drawer::render(std::span<const Picture> pictures) {
    const auto count = static_cast<int>(pictures.size());
    const int cores = execution_.threads > 0 ? execution_.threads : available_cores();
    const int wanted = std::max(1, std::min(count, cores));
    while (static_cast<int>(workers_.size()) < wanted) {
        auto copy = workers_[0]->renderer.copy();
        if (!copy) return tl::unexpected<Error>(copy.error());
        workers_.push_back(std::make_unique<Worker>(Worker{std::move(*copy), {}, {}, {}}));
    }
    const auto start = std::chrono::steady_clock::now();
    Execution each = execution_;
    each.on_tile = {}, each.progress = {};
    if (count <= 1) return count == 0 ? Result<void>{} : draw(*workers_[0], pictures[0], each, start);

    each.threads = std::max(1, cores / wanted);
    each.parallel_for = {};
    std::atomic<int> next{0}, tried{0};
    std::mutex mutex;
    std::vector<Worker*> idle;
    for (const auto& worker : workers_) idle.push_back(worker.get());
    std::pair<int, Result<void>> first{count, {}};  // the first picture that failed
    // The index does not count, since the loop may be the host's.
    const auto work = [&](int) {
        std::unique_lock lock(mutex);
        if (idle.empty()) return;
        Worker& by = *idle.back();
        idle.pop_back();
        lock.unlock();
        for (int i = next++; i < count; i = next++, ++tried) {
            Result<void> done;
            try {
                done = draw(by, pictures[static_cast<std::size_t>(i)], each, start);
            } catch (const std::bad_alloc&) {
                done = fail(ErrorCode::limit, "out of memory");
            }
            if (done) continue;
            const std::lock_guard failed(mutex);
            if (i < first.first) first = {i, std::move(done)};
            next = count;
        }
        lock.lock();
        idle.push_back(&by);
    };
    if (execution_.parallel_for) {
        execution_.parallel_for(wanted, work);
        if (first.second && tried != count) return fail(ErrorCode::usage, "parallel_for returned before every item was done");
        return first.second;
    }
    std::vector<std::jthread> others;
    try {
        for (int worker = 1; worker < wanted; ++worker) others.emplace_back(work, worker);
    } catch (const std::system_error&) {
        // Fewer threads do it too.
    }
    work(0);
    others.clear();  // waits for them
    return first.second;
}

}  // namespace halflit::engine::mujoco
