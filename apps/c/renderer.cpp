// Functions of halflit.h that draw.
#include "apps/c/convert.hpp"
#include "apps/c/interrupt.hpp"
#include "apps/c/scene_access.hpp"
#include "apps/c/versioned.hpp"

#include <halflit/renderer.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace halflit;
using namespace halflit::c;

struct halflit_renderer {
    Renderer renderer;
    Execution execution;
    bool stops_at_interrupt = false;
    std::vector<std::string> warnings;
    std::atomic<bool> busy{false};
};

namespace {

/// Counts a frame in halflit_scene::drawing, so that nothing changes the scene meanwhile.
class DrawingScene {
public:
    explicit DrawingScene(const halflit_scene& scene) : scene_(scene) { add(1); }
    ~DrawingScene() { add(-1); }
    DrawingScene(const DrawingScene&) = delete;
    DrawingScene& operator=(const DrawingScene&) = delete;

private:
    void add(int count) {
        const std::lock_guard lock(scene_.access);
        scene_.drawing += count;
    }
    const halflit_scene& scene_;
};

/// Runs body(), which uses the renderer. Fails (usage) if another thread uses it, or a function that it called.
template <class Body>
std::int32_t using_renderer(const char* function, halflit_renderer* renderer, std::initializer_list<Pointer> pointers,
                            const Body& body) noexcept {
    if (renderer == nullptr) return record_failure(ErrorCode::usage, function, "renderer is null");
    if (renderer->busy.exchange(true)) return record_failure(ErrorCode::usage, function, "the renderer is drawing another frame");
    const std::int32_t code = guarded(function, pointers, body);
    renderer->busy = false;
    return code;
}

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// The light to draw by. The scene's lights in the one that was chosen are drawn as they are now: if they have moved, in a copy.
const Lighting& light_of(const Scene& scene, const halflit_lighting* chosen, std::optional<Lighting>& moved) {
    if (chosen == nullptr) return scene;
    const std::size_t count = std::min(chosen->scene_lights, scene.lights.size());
    const auto end = scene.lights.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::equal(scene.lights.begin(), end, chosen->light.lights.begin())) return chosen->light;
    moved = chosen->light;
    std::copy(scene.lights.begin(), end, moved->lights.begin());
    return *moved;
}

/// Pixels of a plane without gaps; 0 for a size that is refused.
std::size_t pixels_of(const halflit_target& target, const Region& region) {
    const bool alone = target.region_alone != 0 && region.width > 0;
    const std::int32_t width = alone ? region.width : target.width, height = alone ? region.height : target.height;
    if (width < 1 || height < 1 || std::int64_t{width} * height > std::int64_t{1} << 28) return 0;
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Prepares the scene, if it has changed, and draws it.
Result<RenderReport> draw(halflit_renderer& by, const halflit_scene& scene, const halflit_lighting* lighting, const Camera& camera,
                          const Settings& settings, const Target& target) {
    const InterruptWatch watch(by.stops_at_interrupt);
    const Execution execution = watch.stopping(by.execution);
    const auto start = std::chrono::steady_clock::now();
    const DrawingScene drawing(scene);
    if (auto ok = scene.prepare(execution); !ok) return tl::unexpected<Error>(ok.error());
    const double prepare_ms = ms_since(start);
    std::optional<Lighting> moved;
    const Lighting& light = light_of(scene.scene, lighting, moved);
    auto report = by.renderer.render(*scene.prepared, light, camera, settings, target, execution);
    if (!report) return report;
    report->ms.prepare = prepare_ms;
    report->total_ms += prepare_ms;
    return report;
}

}  // namespace

int32_t halflit_execution_init(halflit_execution* execution, size_t size) {
    return guarded(__func__, {{execution, "execution"}},
                   [&] { return write_struct(default_execution(), size, execution, "halflit_execution"); });
}

int32_t halflit_target_init(halflit_target* target, size_t size) {
    return guarded(__func__, {{target, "target"}}, [&] { return write_struct(default_target(), size, target, "halflit_target"); });
}

int32_t halflit_renderer_create(const halflit_execution* given, halflit_renderer** renderer) {
    return guarded(__func__, {{renderer, "renderer"}}, [&]() -> Result<void> {
        auto how = execution(given);
        if (!how) return tl::unexpected<Error>(how.error());
        auto made = std::make_unique<halflit_renderer>();
        made->execution = std::move(*how);
        made->stops_at_interrupt = stops_at_interrupt(given);
        *renderer = made.release();
        return {};
    });
}

int32_t halflit_renderer_set_execution(halflit_renderer* renderer, const halflit_execution* given) {
    return using_renderer(__func__, renderer, {}, [&]() -> Result<void> {
        auto how = execution(given);
        if (!how) return tl::unexpected<Error>(how.error());
        renderer->execution = std::move(*how);
        renderer->stops_at_interrupt = stops_at_interrupt(given);
        return {};
    });
}

void halflit_renderer_destroy(halflit_renderer* renderer) { delete renderer; }

int32_t halflit_render(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting,
                       const halflit_camera* given_camera, const halflit_settings* given_settings, const halflit_target* given_target,
                       halflit_report* to_report) {
    return using_renderer(
        __func__, renderer, {{scene, "scene"}, {given_camera, "camera"}, {given_target, "target"}}, [&]() -> Result<void> {
            if (to_report != nullptr)
                if (auto ok = check_size(to_report->size, sizeof(halflit_report), "halflit_report"); !ok) return ok;
            const auto from = camera(given_camera);
            if (!from) return tl::unexpected<Error>(from.error());
            const auto how = settings(given_settings);
            if (!how) return tl::unexpected<Error>(how.error());
            const auto memory = target_struct(given_target);
            if (!memory) return tl::unexpected<Error>(memory.error());
            renderer->warnings.clear();
            std::vector<std::uint32_t> surfaces;
            halflit_target planes = *memory;
            if (scene->world.moves() && planes.position != nullptr && planes.depth == nullptr && planes.instance == nullptr) {
                surfaces.resize(pixels_of(planes, how->region));
                planes.instance = surfaces.data(), planes.instance_row_bytes = 0;
            }
            auto report = draw(*renderer, *scene, lighting, scene->world.into(*from), scene->world.into(*how), target(planes));
            if (!report) return tl::unexpected<Error>(report.error());
            scene->world.out(planes, how->region);
            if (to_report != nullptr) (void)write_struct(to_c(*report), to_report, "halflit_report");  // its size was checked above
            renderer->warnings = std::move(report->warnings);
            return {};
        });
}

int32_t halflit_measured_init(halflit_measured* measured, size_t size) {
    return guarded(__func__, {{measured, "measured"}}, [&] {
        halflit_measured usual{};
        usual.codes = kFastQuality.codes, usual.asked_percent = kFastQuality.percent;
        return write_struct(usual, size, measured, "halflit_measured");
    });
}

int32_t halflit_measure(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting,
                        const halflit_camera* given_camera, const halflit_settings* given_settings, int32_t width, int32_t height,
                        halflit_measured* measured) {
    return using_renderer(__func__, renderer, {{scene, "scene"}, {given_camera, "camera"}, {measured, "measured"}}, [&]() -> Result<void> {
        const auto from = camera(given_camera);
        if (!from) return tl::unexpected<Error>(from.error());
        const auto how = settings(given_settings);
        if (!how) return tl::unexpected<Error>(how.error());
        const auto given = read_struct(measured, halflit_measured{}, "halflit_measured");
        if (!given) return tl::unexpected<Error>(given.error());
        const MeasuredShare known{{given->codes, given->asked_percent},
                                  given->percent,
                                  given->probes,
                                  given->outside,
                                  given->samples,
                                  given->anisotropy,
                                  given->shadow_size};
        const bool is_known = known.probes > 0;
        const InterruptWatch watch(renderer->stops_at_interrupt);
        const Execution execution = watch.stopping(renderer->execution);
        const DrawingScene drawing(*scene);
        if (auto ok = scene->prepare(execution); !ok) return ok;
        std::optional<Lighting> moved;
        const auto found = Renderer::measure(*scene->prepared, light_of(scene->scene, lighting, moved), scene->world.into(*from),
                                             scene->world.into(*how), known.asked, width, height, is_known ? &known : nullptr, execution);
        if (!found) return tl::unexpected<Error>(found.error());
        halflit_measured out = *given;
        out.percent = found->percent, out.probes = found->probes, out.outside = found->outside;
        out.samples = found->samples, out.anisotropy = found->anisotropy, out.shadow_size = found->shadow_size;
        return write_struct(out, measured->size, measured, "halflit_measured");
    });
}

int32_t halflit_renderer_get_warning(const halflit_renderer* renderer, int32_t index, const char** text) {
    return guarded(__func__, {{renderer, "renderer"}, {text, "text"}}, [&]() -> Result<void> {
        const auto at = check_index(index, renderer->warnings.size(), "warning", "the frame");
        if (!at) return tl::unexpected<Error>(at.error());
        *text = renderer->warnings[*at].c_str();
        return {};
    });
}
