// Memory that an environment holds: none by default, and of an image only what was asked for.
#include "shading/environment.hpp"
#include "shading/plan/environment_plans.hpp"

#include "tests/support/catch.hpp"

#include <optional>
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
#include <malloc.h>
#define HALFLIT_HAS_MALLINFO 1
#endif

#include "tests/support/skip.hpp"

using namespace halflit;
using namespace halflit::shading;

namespace {

/// Bytes of the heap in use, or nullopt if the C library does not tell. Valid for one thread.
std::optional<std::int64_t> heap_bytes() {
#if defined(HALFLIT_HAS_MALLINFO)
    const struct mallinfo2 info = mallinfo2();
    const auto bytes = static_cast<std::int64_t>(info.uordblks + info.hblkhd);
    if (bytes > 0) return bytes;  // a sanitizer's allocator is not counted
#endif
    return {};
}

Environment of_image(int width, int height, const EnvironmentOptions& options = {}) {
    std::vector<float> rgb;
    for (int i = 0; i < width * height; ++i) rgb.insert(rgb.end(), {0.5f, 0.4f, static_cast<float>(i % width) / static_cast<float>(width)});
    return shading::make_environment(sh::EquirectView{width, height, rgb}, options);
}

}  // namespace

TEST_CASE("environment: one that was not made holds no memory and is dark", "[shading][environment]") {
    const Environment none;
    CHECK(none.suns.capacity() == 0);
    CHECK(none.rgb.capacity() == 0);
    CHECK(none.light == nullptr);
    const shading::EnvironmentPlan plan = shading::plan_environment(none, sh::WrapLobe{}, {});
    CHECK(plan.bound == 0);
    for (const float coefficient : plan.red) CHECK(coefficient == 0);
    CHECK(sizeof(Environment) < 16'384);
}

TEST_CASE("environment: a default one, and a default grid, allocate nothing", "[shading][environment]") {
    if (!heap_bytes()) HALFLIT_SKIP("no count of the heap's bytes");
    const std::int64_t before = *heap_bytes();
    const Environment none;
    const sh::BandGrid grid;
    const Environment copy = none;
    const std::int64_t after = *heap_bytes();
    CHECK(after == before);
    CHECK(copy.width == 0);
}

TEST_CASE("environment: made from a small image it holds the 5 MB grid of its bands and little else", "[shading][environment]") {
    if (!heap_bytes()) HALFLIT_SKIP("no count of the heap's bytes");
    constexpr std::int64_t kGrid = 24 * 96 * 192 * sizeof(Vec3f), kLittle = 64 << 10;
    const std::int64_t before = *heap_bytes();
    auto environment = std::make_unique<Environment>(of_image(32, 16));
    const std::int64_t held = *heap_bytes() - before;
    environment.reset();
    INFO("held " << held);
    CHECK(held <= kGrid + kLittle);
    CHECK(*heap_bytes() - before <= kLittle);
}

TEST_CASE("environment: the image with its suns is kept only if it is asked for, that without them for reflections",
          "[shading][environment]") {
    const Environment neither = of_image(32, 16), image = of_image(32, 16, {.keep_image = true}),
                      light = of_image(32, 16, {.keep_light = true});
    CHECK(neither.rgb.capacity() == 0);
    CHECK(neither.light->image().rgb.size() == 3 * 32 * 16);
    CHECK(image.rgb.size() == 3 * 32 * 16);
    CHECK(image.light->image().rgb.size() == 3 * 32 * 16);
    CHECK(light.rgb.capacity() == 0);
    CHECK(light.light->image().rgb.size() == 3 * 32 * 16);
}
