// A host's own threads
// They draw the frame, show each tile when it is finished, and may stop it.   halflit_host_threads OUT.png
#include <halflit/image.hpp>
#include <halflit/renderer.hpp>

#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

using namespace halflit;

namespace {

/// A pool of threads, reduced to the least: an engine passes its own here.
void run_on_host_threads(int count, const std::function<void(int)>& body) {
    std::atomic<int> next{0};
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < 3; ++i)
        threads.emplace_back([&] {
            for (int item = next++; item < count; item = next++) body(item);
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace

int main(int argc, char** argv) {
    const Scene scene = demo_scene();
    Image image = Image::make(480, 270);

    std::atomic<int> tiles{0}, pixels{0};
    std::atomic<bool> stop{false};  // a host sets it from any thread, for example when its window closes
    Execution execution;
    execution.parallel_for = run_on_host_threads;
    execution.cancelled = [&] { return stop.load(); };
    execution.on_tile = [&](const Region& tile) {  // called by the host's threads; these pixels are final
        ++tiles;
        pixels += tile.width * tile.height;
    };
    execution.progress = [](double share) { std::fprintf(stderr, "\r%3.0f %%", 100 * share); };

    const auto report = render(scene, scene.cameras[0], {.samples = 4}, image.target(), execution);
    if (!report) {
        std::fprintf(stderr, "%s\n", report.error().message.c_str());
        return static_cast<int>(report.error().code);
    }
    std::printf("\n%d tiles, %d pixels\n", tiles.load(), pixels.load());
    const auto written = write_image(argc > 1 ? argv[1] : "host_threads.png", image);
    if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
    return written ? 0 : static_cast<int>(written.error().code);
}
