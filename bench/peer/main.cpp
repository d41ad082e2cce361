// Frames of halflit against frames of Mesa's llvmpipe, of the same scenes. Each scene, number of threads and number of samples is measured
// in a process of its own.
// Exit code: 0 measured, 1 failed or the pictures differ, 2 usage, 4 skipped (no llvmpipe here).
#include "bench/peer/flags.hpp"
#include "bench/peer/results.hpp"
#include "tests/peer/mesa_context.hpp"
#include "tests/support/glb_writer.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

using namespace halflit;
using namespace halflit::peer;

namespace {

struct Found {
    bool there = false;
    char text[200] = "";  ///< the renderer's name, or why there is none
};

Found find_peer() {
    Found found;
    std::string reason;
    const auto context = MesaContext::create(reason);
    found.there = context != nullptr;
    std::snprintf(found.text, sizeof found.text, "%s", found.there ? context->renderer().c_str() : reason.c_str());
    return found;
}

int write_scenes(const Flags& flags) {
    std::filesystem::create_directories(flags.glb);
    for (const std::string& name : flags.scenes) {
        const Limits limits = limits_for(name, flags.limits);
        const double aspect = static_cast<double>(limits.width) / limits.height;
        const BenchScene bench = make_bench_scene(name, static_cast<float>(aspect));
        test::GlbContent content{bench.scene, bench.camera, aspect, {}, "halflit_peer_bench"};
        for (const Picture& picture : bench.pictures) content.pictures.push_back({picture.width, picture.height, picture.rgba8});
        const std::string path = flags.glb + "/" + name + ".glb";
        const auto glb = test::glb_of(content);
        const auto written = glb ? test::write_file(path, glb->data(), glb->size()) : tl::unexpected(glb.error());
        if (!written) return std::fprintf(stderr, "peer bench: %s\n", written.error().message.c_str()), 1;
        std::printf("%s\n", path.c_str());
    }
    return 0;
}

/// A folder for llvmpipe's cache of shaders, empty at first.
class ShaderCache {
public:
    ShaderCache() {
        char name[] = "/tmp/halflit_peer_XXXXXX";
        folder_ = mkdtemp(name) != nullptr ? name : "";
        setenv("MESA_SHADER_CACHE_DIR", folder_.c_str(), 1);
    }
    ~ShaderCache() {
        std::error_code ignored;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
    }
    void clear() const {
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) std::filesystem::remove_all(entry, ignored);
    }

private:
    std::string folder_;
};

template <class Measure>
auto measured(const Subject& subject, const Limits& limits, const Measure& measure) {
    auto result = in_child([&] {
        set_up_process(subject.threads, subject.filter);
        return measure(subject, limits_for(subject.scene, limits));
    });
    if (!result) {
        result.emplace();
        std::snprintf(result->reason, sizeof result->reason, "the process ended early");
    }
    return *result;
}

std::vector<Subject> subjects_of(const Flags& flags) {
    std::vector<Subject> subjects;
    for (const int samples : flags.samples)
        for (const int threads : flags.threads)
            for (const std::string& scene : flags.scenes) {
                Subject subject{scene, threads, samples, false, flags.storage, flags.filter, flags.shader, flags.pictures};
                subjects.push_back(subject);
                subject.depth_first = true;
                if (scene == "overdraw") subjects.push_back(subject);
            }
    return subjects;
}

}  // namespace

int main(int argc, char** argv) {
    int code = 0;
    const std::optional<Flags> flags = read_flags(argc, argv, code);
    if (!flags) return code;
    if (!flags->glb.empty()) return write_scenes(*flags);
    const ShaderCache cache;
    const std::optional<Found> found = in_child(find_peer);
    if (!found || !found->there) {
        std::printf("skipped: no llvmpipe: %s\n", found ? found->text : "the driver crashed");
        return 4;
    }
    std::printf("%s, milliseconds (median)\n", found->text);

    const std::vector<Isa> isas = measured_isas();
    bool good = true;
    std::vector<TurnsRow> turns;
    std::vector<FirstRow> first;
    // After each row, so that a run that is ended leaves its tables; and once before, so that a folder that cannot be written is said
    // early.
    const auto save = [&] {
        if (flags->csv.empty() || write_csv(flags->csv, turns, first, isas)) return true;
        std::fprintf(stderr, "peer bench: %s: cannot be written\n", flags->csv.c_str());
        return false;
    };
    if (!save()) return 1;
    print_turns_head(isas);
    for (const Subject& subject : subjects_of(*flags)) {
        turns.push_back({subject, measured(subject, flags->limits, is_dataset(subject.scene) ? measure_dataset : measure_turns)});
        good = good && turns.back().turns.reason[0] == '\0' && pictures_agree(turns.back());
        print_turns(turns.back(), isas);
        if (!save()) return 1;
    }
    print_means(turns, isas);

    if (flags->first) print_first_head();
    for (const Subject& subject : subjects_of(*flags)) {
        if (!flags->first || subject.depth_first || is_dataset(subject.scene)) continue;
        cache.clear();
        FirstRow row{subject, {}, {}, {}};
        row.cold = measured(subject, flags->limits, measure_first_of_peer);
        row.warm = measured(subject, flags->limits, measure_first_of_peer);
        row.halflit = measured(subject, flags->limits, measure_first_of_halflit);
        print_first(row);
        first.push_back(row);
        if (!save()) return 1;
    }
    return good ? 0 : 1;
}
