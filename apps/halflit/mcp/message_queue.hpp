// Messages from standard input: one a line, read by a thread of its own, so that a notification can cancel the call that runs.
#pragma once

#include "apps/io/platform/handles.hpp"

#include <nlohmann/json.hpp>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace halflit::cli {

inline constexpr std::size_t kMostMessageBytes = std::size_t{1} << 20;  ///< a longer line is refused
inline constexpr std::size_t kMostMessageDepth = 32;                    ///< objects and arrays inside each other

/// A message as it came: JSON, or why it is none. Keys are sorted, so that many of them do not take quadratic time.
struct Incoming {
    nlohmann::json message;
    int error = 0;       ///< code of JSON-RPC; 0: none
    std::string reason;  ///< of the error
    std::size_t bytes = 0;
    bool cancelled = false;
};

/// Reads one line. Its depth is bounded first.
[[nodiscard]] Incoming parse_message(std::string_view line);

class MessageQueue {
public:
    /// Starts the thread. It ends with the input; the object lives as long.
    [[nodiscard]] static std::shared_ptr<MessageQueue> start(platform::NativeHandle input);

    /// Waits for a message that was not cancelled, which runs from then on; none: the input has ended.
    [[nodiscard]] std::optional<Incoming> next();

    /// From now on the call of this id runs, one of a batch if it is not that of next(). A cancellation sets cancelled().
    void begin_call(const nlohmann::json& id);
    void end_call();
    [[nodiscard]] bool cancelled() const { return cancelled_; }

private:
    void read_all(platform::NativeHandle input);
    void end();
    void push(Incoming message);
    void take_line(std::string_view line);
    void cancel(const nlohmann::json& notification);

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Incoming> waiting_;
    std::size_t waiting_bytes_ = 0;
    bool ended_ = false;
    nlohmann::json running_;  ///< id of the call; null: none runs
    std::atomic<bool> cancelled_ = false;
};

}  // namespace halflit::cli
