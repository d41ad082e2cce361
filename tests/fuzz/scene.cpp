// A scene to its picture. The last kFlagBytes of the input are flags. What is before them is a GLB, or else numbers that a scene is made
// of.
#include "tests/fuzz/canvas.hpp"
#include "tests/fuzz/loading.hpp"
#include "tests/fuzz/mutate.hpp"

#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"

#include <optional>

namespace halflit::fuzz {
namespace {

constexpr std::size_t kFlagBytes = 128;
/// Triangles over all instances, times one and the number of lights: their shadow maps are most of the work.
constexpr std::uint64_t kMaxWork = 20000;

std::optional<Scene> read_scene(View input) {
    if (input.size() >= 4 && std::memcmp(input.data(), "glTF", 4) == 0) {
        auto loaded = load_gltf_bytes(as_bytes(input), "fuzz.glb", "", small_limits(true));
        if (!loaded) return std::nullopt;
        return std::move(loaded->scene);
    }
    Input numbers(input);
    return scene_by_code(numbers);
}

/// Draws; the error, if there is one.
std::optional<Error> draw(Renderer& renderer, const PreparedScene& prepared, const RenderFlags& flags, const Execution& execution,
                          Canvas& canvas) {
    const auto report = renderer.render(prepared, flags.camera, flags.settings, canvas.target, execution);
    if (!report) return report.error();
    return std::nullopt;
}

void check_twin(const PreparedScene& prepared, const RenderFlags& flags, const Canvas& canvas, const std::optional<Error>& error) {
    Execution other;
    other.threads = 2;
    other.isa = Isa::scalar;
    other.tile_size = flags.tile_size == 16 ? 64 : 16;
    Renderer renderer;
    Canvas twin(flags);
    const auto twin_error = draw(renderer, prepared, flags, other, twin);
    HALFLIT_PROMISE(error.has_value() == twin_error.has_value());
    HALFLIT_PROMISE(error || canvas.same_as(twin));
}

void render(Scene& scene, RenderFlags flags, Input& input) {
    if (flags.environment) {
        const auto environment = make_environment(small_environment(input), {true, 0.5, true, true});
        HALFLIT_PROMISE(environment.has_value());
        scene.environment = *environment;
    }
    AutoOptions choice;
    if (flags.own_camera) choice.camera = flags.camera;
    // The reference integrates the studio for seconds, and each scene makes it anew.
    const bool reference = flags.settings.shading.accuracy == Accuracy::reference;
    choice.studio = reference || flags.width % 4 != 0 ? StudioUse::never : StudioUse::for_dark;
    const AutoSetup setup = auto_setup(scene, flags.width, flags.height, choice);
    flags.camera = setup.camera;
    static_cast<Lighting&>(scene) = setup.light;
    if (flags.settings.exposure == 1.0f) flags.settings.exposure = setup.settings.exposure;

    Execution execution;
    execution.threads = 1;
    execution.tile_size = flags.tile_size;
    const auto prepared = PreparedScene::make(scene, execution);
    if (!prepared || prepared->triangle_count() * (1 + scene.lights.size()) > kMaxWork) return;
    Renderer renderer;
    Canvas canvas(flags);
    const auto error = draw(renderer, *prepared, flags, execution, canvas);
    if (!error) canvas.check(flags.settings.region, scene);
    if (error) HALFLIT_PROMISE(error->code != ErrorCode::internal && !error->message.empty());
    if (flags.scalar_twin) check_twin(*prepared, flags, canvas, error);
    if (flags.frame_twin && !error) {
        Canvas again(flags);
        HALFLIT_PROMISE(!draw(renderer, *prepared, flags, execution, again) && again.same_as(canvas));
    }
}

void run(View input) {
    const std::size_t size = input.size() > kFlagBytes ? input.size() - kFlagBytes : 0;
    auto scene = read_scene(input.first(size));
    if (!scene) return;
    Input numbers(input.subspan(size));
    const RenderFlags flags = read_flags(numbers);
    render(*scene, flags, numbers);
}

void mutate(Bytes& file, std::size_t max_bytes, Random& random) {
    if (file.size() < kFlagBytes) file.resize(kFlagBytes);
    const auto middle = file.end() - static_cast<std::ptrdiff_t>(kFlagBytes);
    Bytes model(file.begin(), middle), flags(middle, file.end());
    if (random.one_in(2)) {
        const std::size_t times = 1 + random.below(6);
        for (std::size_t i = 0; i < times; ++i) random.pick(flags) = static_cast<std::uint8_t>(random.next());
    } else if (model.size() > 4 && std::memcmp(model.data(), "glTF", 4) == 0) {
        mutate_glb(model, max_bytes - kFlagBytes, random);
    } else {
        mutate_bytes(model, max_bytes - kFlagBytes);
    }
    file = std::move(model);
    file.insert(file.end(), flags.begin(), flags.end());
}

}  // namespace

const FuzzTarget kScene{"scene", 16384, run, mutate};

}  // namespace halflit::fuzz
