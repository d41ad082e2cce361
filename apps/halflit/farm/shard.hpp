// Shards: parts of a run that processes draw beside each other, on one machine or on many.
#pragma once

#include "apps/engine/request/film_options.hpp"
#include "apps/halflit/program/engine.hpp"
#include "halflit/settings.hpp"

namespace halflit::cli {

/// A part of a run: the frames or scenes at places index, index + count, ...; of one picture, a band of rows.
struct Shard {
    std::int64_t index = 0, count = 1;  ///< 0 <= index < count

    /// Its frames; nothing where the run has too few.
    [[nodiscard]] std::optional<FrameRange> frames_of(const FrameRange& whole) const;
    /// Its rows of a region; shards differ by one row at most. Height 0 where the region has too few.
    [[nodiscard]] Region rows_of(const Region& whole) const;
    /// The file's name with the shard in front of its extension: "turn.json" becomes "turn.03-of-64.json".
    [[nodiscard]] std::string name_of(const std::string& path) const;
};

/// The most shards of a run.
inline constexpr std::int64_t kMostShards = 1'000'000;

/// "I/N" with I from 0 to N - 1, or "auto/N": I is the number of the task that a scheduler put into the environment: SLURM_ARRAY_TASK_ID,
/// JOB_COMPLETION_INDEX (Kubernetes), AWS_BATCH_JOB_ARRAY_INDEX, or PARALLEL_SEQ (GNU parallel) - 1. "auto" takes N from the environment
/// too, which Slurm and AWS Batch tell. Fails (usage) for none or several of these, and where a Slurm array is not 0-(N-1).
[[nodiscard]] Result<Shard> parse_shard(std::string_view text);

}  // namespace halflit::cli
