#include "bench/peer/results.hpp"

#include "halflit/isa.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace halflit::peer {
namespace {

std::string name_of(const Subject& subject) { return subject.scene + (subject.depth_first ? "+prepass" : ""); }
std::string name_of(Isa isa) { return std::string(isa_name(isa)); }

/// Processor and widest instruction set, as in the names of bench/results.
std::string machine_name(Isa widest) {
    utsname system{};
    return (uname(&system) == 0 ? std::string(system.machine) : "unknown") + "_" + name_of(widest);
}

/// A second line for data sets.
void print_planes(const Turns& t, const std::vector<Isa>& isas) {
    std::printf("    views a second: llvmpipe %.0f", 1000 / t.peer_ms.median);
    for (std::size_t i = 0; i < isas.size(); ++i) std::printf(", %s %.0f", name_of(isas[i]).c_str(), 1000 / t.halflit_ms[i].median);
    const auto print = [&](const char* name, const Differing& differing) {
        std::printf(", %s %.3f %%", name,
                    100 * static_cast<double>(differing.all) / static_cast<double>(std::max<std::int64_t>(t.planes.pixels, 1)));
    };
    std::printf("; differing");
    print("triangles", t.planes.triangles);
    print("depths", t.planes.depths);
    print("points", t.planes.points);
    std::printf("\n");
}

}  // namespace

bool pictures_agree(const TurnsRow& row) {
    const double limit = row.subject.samples == 1 ? kMostAbove2 : kMostAbove2OfSamples;
    const PlanesDifference& planes = row.turns.planes;
    if (is_dataset(row.subject.scene) && planes.pixels == 0) return false;  // nothing was compared
    const auto kept = [&](const Differing& differing, double most) {
        return differing.inner == 0 && static_cast<double>(differing.all) <= most * static_cast<double>(planes.pixels);
    };
    if (!kept(planes.triangles, kMostOther) || !kept(planes.depths, kMostOther)) return false;
    if (!kept(planes.points, row.subject.samples == 1 ? kMostOther : kMostAbove2OfSamples)) return false;
    return row.subject.filter != PeerFilter::usual || row.turns.pictures.share_above_2() <= limit;
}

void print_turns_head(const std::vector<Isa>& isas) {
    std::printf("%-17s %7s %7s %7s %9s %9s", "scene", "samples", "threads", "rounds", "llvmpipe", "readback");
    for (const Isa isa : isas) std::printf("  %8s %21s", name_of(isa).c_str(), "ratio (quartiles)");
    std::printf("  %6s %s\n", "codes", "above 2");
}

void print_turns(const TurnsRow& row, const std::vector<Isa>& isas) {
    const Turns& t = row.turns;
    std::printf("%-17s %7d %7d", name_of(row.subject).c_str(), row.subject.samples, row.subject.threads);
    if (t.reason[0] != '\0') {
        std::printf("  %s\n", t.reason);
        return;
    }
    std::printf(" %7d %9.2f %9.2f", t.rounds, t.peer_ms.median, t.readback_ms.median);
    for (std::size_t i = 0; i < isas.size(); ++i)
        std::printf("  %8.2f %7.2f (%.2f .. %.2f)", t.halflit_ms[i].median, t.ratio[i].median, t.ratio[i].first_quarter,
                    t.ratio[i].third_quarter);
    std::printf("  %6d %.3f %%%s\n", t.pictures.largest, 100 * t.pictures.share_above_2(), pictures_agree(row) ? "" : " (too many)");
    if (is_dataset(row.subject.scene)) print_planes(t, isas);
    std::fflush(stdout);
}

void print_means(const std::vector<TurnsRow>& rows, const std::vector<Isa>& isas) {
    const auto counts = [](const TurnsRow& row) {
        return !row.subject.depth_first && !is_dataset(row.subject.scene) && row.turns.rounds > 0;
    };
    std::vector<std::pair<int, int>> kinds;  // samples, threads
    for (const TurnsRow& row : rows) {
        const std::pair kind{row.subject.samples, row.subject.threads};
        if (counts(row) && (kinds.empty() || kinds.back() != kind)) kinds.push_back(kind);
    }
    for (const auto& [samples, threads] : kinds) {
        std::printf("geometric mean, %d samples, %d threads, no pre-pass:", samples, threads);
        for (std::size_t i = 0; i < isas.size(); ++i) {
            double sum = 0;
            int count = 0;
            for (const TurnsRow& row : rows) {
                if (!counts(row) || row.subject.samples != samples || row.subject.threads != threads) continue;
                sum += std::log(row.turns.ratio[i].median);
                ++count;
            }
            std::printf("  %s %.2f of %d scenes", name_of(isas[i]).c_str(), std::exp(sum / count), count);
        }
        std::printf("\n");
    }
}

void print_first_head() {
    std::printf("\nfirst frame of a process, memory for it\n%-17s %7s %7s %14s %14s %9s %11s %10s\n", "scene", "samples", "threads",
                "llvmpipe, cold", "llvmpipe, warm", "halflit", "llvmpipe MB", "halflit MB");
}

void print_first(const FirstRow& row) {
    std::printf("%-17s %7d %7d %14.1f %14.1f %9.1f %11.1f %10.1f\n", row.subject.scene.c_str(), row.subject.samples, row.subject.threads,
                row.cold.ms, row.warm.ms, row.halflit.ms, row.cold.memory_mb, row.halflit.memory_mb);
    std::fflush(stdout);
}

bool write_csv(const std::string& folder, const std::vector<TurnsRow>& turns, const std::vector<FirstRow>& first,
               const std::vector<Isa>& isas) {
    const std::string machine = machine_name(isas.back());
    std::error_code error;
    std::filesystem::create_directories(folder, error);  // if it fails, so does opening
    std::FILE* file = std::fopen((folder + "/peer_" + machine + ".csv").c_str(), "w");
    if (file == nullptr) return false;
    std::fprintf(file,
                 "scene,samples,threads,set,rounds,llvmpipe_ms,llvmpipe_least_ms,readback_ms,halflit_ms,halflit_least_ms,ratio,"
                 "ratio_first_quarter,ratio_third_quarter,largest_codes,share_above_2\n");
    for (const TurnsRow& row : turns) {
        const Turns& t = row.turns;
        for (std::size_t i = 0; i < isas.size() && t.rounds > 0; ++i)
            std::fprintf(file, "%s,%d,%d,%s,%d,%.2f,%.2f,%.2f,%.2f,%.2f,%.3f,%.3f,%.3f,%d,%.6f\n", name_of(row.subject).c_str(),
                         row.subject.samples, row.subject.threads, name_of(isas[i]).c_str(), t.rounds, t.peer_ms.median, t.peer_ms.least,
                         t.readback_ms.median, t.halflit_ms[i].median, t.halflit_ms[i].least, t.ratio[i].median, t.ratio[i].first_quarter,
                         t.ratio[i].third_quarter, t.pictures.largest, t.pictures.share_above_2());
    }
    bool good = std::fclose(file) == 0;
    if (first.empty()) return good;
    file = std::fopen((folder + "/peer_first_" + machine + ".csv").c_str(), "w");
    if (file == nullptr) return false;
    std::fprintf(file, "scene,samples,threads,llvmpipe_cold_ms,llvmpipe_warm_ms,halflit_ms,llvmpipe_mb,halflit_mb\n");
    for (const FirstRow& row : first)
        std::fprintf(file, "%s,%d,%d,%.2f,%.2f,%.2f,%.1f,%.1f\n", row.subject.scene.c_str(), row.subject.samples, row.subject.threads,
                     row.cold.ms, row.warm.ms, row.halflit.ms, row.cold.memory_mb, row.halflit.memory_mb);
    good = std::fclose(file) == 0 && good;
    return good;
}

}  // namespace halflit::peer
