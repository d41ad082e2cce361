#include "apps/halflit/farm/shard.hpp"

#include "apps/engine/request/values.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace halflit::cli {
namespace {

/// Environment variables by which a scheduler numbers its tasks.
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

/// The shard of the task that a scheduler has started. count 0: the scheduler tells it.
Result<Shard> shard_of_task(std::int64_t count) {
    const Scheduler* found = nullptr;
    std::string known, there;
    for (const Scheduler& scheduler : kSchedulers) {
        known += (known.empty() ? "" : ", ") + std::string(scheduler.task);
        if (std::getenv(scheduler.task) == nullptr) continue;
        found = there.empty() ? &scheduler : nullptr;
        there += (there.empty() ? "" : " and ") + std::string(scheduler.task);
    }
    if (found == nullptr)
        return fail(ErrorCode::usage,
                    fmt::format("auto: expected one of the variables {} in the environment, found {}; I/N names the shard", known,
                                there.empty() ? "none" : there));
    const auto number = [](const char* name, std::int64_t min, std::int64_t max) -> Result<std::int64_t> {
        const char* const set = std::getenv(name);
        const std::string_view text = set == nullptr ? "" : set;
        if (const auto value = parse_int(text, min, max)) return *value;
        return fail(ErrorCode::usage, fmt::format("auto: expected {} from {} to {}, found '{}'", name, min, max, text));
    };
    if (count == 0) {
        if (found->count == nullptr)
            return fail(ErrorCode::usage, fmt::format("expected auto/N, found 'auto': {} does not tell the number of tasks", found->name));
        const auto told = number(found->count, 1, kMostShards);
        if (!told) return tl::unexpected(told.error());
        // A part of an array, as it is submitted again after failures, has another count.
        if (found == kSchedulers && std::getenv("SLURM_ARRAY_TASK_MAX") != nullptr && !number("SLURM_ARRAY_TASK_MAX", *told - 1, *told - 1))
            return fail(ErrorCode::usage, fmt::format("expected auto/N, found 'auto' in {} tasks of a larger array", *told));
        count = *told;
    }
    const auto task = number(found->task, found->base, found->base + count - 1);
    if (!task) return tl::unexpected(task.error());
    return Shard{*task - found->base, count};
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
    const std::string total = std::to_string(count), own = fmt::format("{:0{}}", index, total.size());
    return path.substr(0, at) + "." + own + "-of-" + total + path.substr(at);
}

Result<Shard> parse_shard(std::string_view text) {
    const std::size_t slash = text.find('/');
    const std::string_view task = text.substr(0, slash);
    if (task == "auto" && slash == std::string_view::npos) return shard_of_task(0);
    const auto count = parse_int(slash == std::string_view::npos ? "" : text.substr(slash + 1), 1, kMostShards);
    if (count && task == "auto") return shard_of_task(*count);
    if (const auto index = parse_int(task, 0, count.value_or(0) - 1)) return Shard{*index, *count};
    return fail(ErrorCode::usage,
                fmt::format("expected I/N, with I from 0 to N - 1 and N up to {}, auto/N or auto, found '{}'", kMostShards, text));
}

}  // namespace halflit::cli
