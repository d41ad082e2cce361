#include "apps/halflit/farm/shard.hpp"

#include "apps/engine/request/values.hpp"

#include <fmt/format.h>

#include <optional>

namespace halflit::cli {
namespace {

/// What a scheduler tells a task.
struct Scheduler {
    const char* name;
    const char* task;   ///< variable of the task's number
    std::int64_t base;  ///< number of the first task
    const char* count;  ///< variable of the number of tasks; null: it tells none
};

constexpr Scheduler kSchedulers[] = {{"Slurm", "SLURM_ARRAY_TASK_ID", 0, "SLURM_ARRAY_TASK_COUNT"},
                                     {"Kubernetes", "JOB_COMPLETION_INDEX", 0, nullptr},
                                     {"AWS Batch", "AWS_BATCH_JOB_ARRAY_INDEX", 0, "AWS_BATCH_JOB_ARRAY_SIZE"},
                                     {"GNU parallel", "PARALLEL_SEQ", 1, nullptr}};

Result<const Scheduler*> find_scheduler(const ReadVariable& variable) {
    const Scheduler* found = nullptr;
    for (const Scheduler& scheduler : kSchedulers) {
        if (variable(scheduler.task) == nullptr) continue;
        if (found != nullptr)
            return fail(ErrorCode::usage,
                        fmt::format("auto: expected one scheduler in the environment, found {} and {}; I/N names the shard", found->task,
                                    scheduler.task));
        found = &scheduler;
    }
    if (found != nullptr) return found;
    std::string names;
    for (const Scheduler& scheduler : kSchedulers) names += fmt::format("{}{}", names.empty() ? "" : ", ", scheduler.task);
    return fail(ErrorCode::usage, "auto: expected one of the variables " + names + " in the environment, found none");
}

Result<std::int64_t> read_number(const char* name, const ReadVariable& variable, std::int64_t min, std::int64_t max) {
    const char* const text = variable(name);
    const auto number = parse_int(text == nullptr ? "" : text, min, max);
    if (!number)
        return fail(ErrorCode::usage,
                    fmt::format("auto: expected {} from {} to {}, found '{}'", name, min, max, text == nullptr ? "" : text));
    return *number;
}

Result<std::int64_t> read_count(const Scheduler& scheduler, const ReadVariable& variable) {
    if (scheduler.count == nullptr)
        return fail(ErrorCode::usage, fmt::format("expected auto/N, found 'auto': {} does not tell the number of tasks", scheduler.name));
    const auto count = read_number(scheduler.count, variable, 1, kMostShards);
    if (!count) return count;
    // A part of an array, as it is submitted again after failures, has another count.
    const char* const last = variable("SLURM_ARRAY_TASK_MAX");
    if (scheduler.task == kSchedulers[0].task && last != nullptr && !parse_int(last, *count - 1, *count - 1))
        return fail(ErrorCode::usage, fmt::format("expected auto/N, found 'auto' in an array of {} tasks up to {}: it does not tell the "
                                                  "number of shards",
                                                  *count, last));
    return count;
}

}  // namespace

std::optional<FrameRange> Shard::frames_of(const FrameRange& whole) const {
    const auto frames = static_cast<std::int64_t>(whole.count());
    if (index >= frames) return std::nullopt;
    const std::int64_t mine = (frames - 1 - index) / count + 1;
    const std::int64_t first = whole.number(static_cast<std::size_t>(index)), step = whole.step * count;
    return FrameRange{first, first + (mine - 1) * step, step};
}

Region Shard::rows_of(const Region& whole) const {
    const auto edge = [&](std::int64_t i) { return static_cast<int>(std::int64_t{whole.height} * i / count); };
    return {whole.x, whole.y + edge(index), whole.width, edge(index + 1) - edge(index)};
}

std::string Shard::name_of(const std::string& path) const {
    const std::size_t name = path.rfind('/') + 1, dot = path.rfind('.');  // npos + 1 is 0
    const std::size_t at = dot == std::string::npos || dot <= name ? path.size() : dot;
    const std::string total = std::to_string(count);
    return path.substr(0, at) + fmt::format(".{:0{}}-of-{}", index, total.size(), total) + path.substr(at);
}

Result<Shard> parse_shard(std::string_view text, const ReadVariable& variable) {
    const auto wrong = [&] {
        return fail(ErrorCode::usage,
                    fmt::format("expected I/N, with I from 0 to N - 1 and N up to {}, auto/N or auto, found '{}'", kMostShards, text));
    };
    const std::size_t slash = text.find('/');
    const std::string_view task = text.substr(0, slash);
    Shard shard;
    if (slash != std::string_view::npos) {
        const auto count = parse_int(text.substr(slash + 1), 1, kMostShards);
        if (!count) return wrong();
        shard.count = *count;
    }
    if (task != "auto") {
        const auto index = parse_int(task, 0, shard.count - 1);
        if (slash == std::string_view::npos || !index) return wrong();
        shard.index = *index;
        return shard;
    }
    const auto scheduler = find_scheduler(variable);
    if (!scheduler) return tl::unexpected(scheduler.error());
    if (slash == std::string_view::npos) {
        const auto count = read_count(**scheduler, variable);
        if (!count) return tl::unexpected(count.error());
        shard.count = *count;
    }
    const std::int64_t base = (*scheduler)->base;
    const auto number = read_number((*scheduler)->task, variable, base, base + shard.count - 1);
    if (!number) return tl::unexpected(number.error());
    shard.index = *number - base;
    return shard;
}

}  // namespace halflit::cli
