#include "apps/halflit/mcp/message_queue.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <thread>
#include <utility>

namespace halflit::cli {
namespace {

constexpr std::size_t kMostWaiting = 256;  // messages; the reader waits then
constexpr std::size_t kMostWaitingBytes = std::size_t{4} << 20;
constexpr int kParseError = -32700;

/// Nesting of brackets outside of strings; stops above the limit.
bool is_too_deep(std::string_view text) {
    std::size_t depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMostMessageDepth) return true;
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return false;
}

Incoming refused_message(std::string reason) {
    Incoming message;
    message.error = kParseError;
    message.reason = std::move(reason);
    return message;
}

}  // namespace

Incoming parse_message(std::string_view line) {
    if (line.size() > kMostMessageBytes)
        return refused_message("expected a message of at most " + std::to_string(kMostMessageBytes) + " bytes");
    if (is_too_deep(line)) return refused_message("expected JSON nested at most " + std::to_string(kMostMessageDepth) + " deep");
    try {
        Incoming message;
        message.message = nlohmann::json::parse(line, nullptr, false);
        message.bytes = line.size();
        if (message.message.is_discarded()) return refused_message("expected a line of JSON");
        return message;
    } catch (const std::bad_alloc&) {
        return refused_message("out of memory");
    }
}

std::shared_ptr<MessageQueue> MessageQueue::start(platform::NativeHandle input) {
    auto queue = std::make_shared<MessageQueue>();
    // The thread may wait for input when the process ends. Without memory, input ends.
    std::thread([queue, input] {
        try {
            queue->read_all(input);
        } catch (const std::bad_alloc&) {
        }
        queue->end();
    }).detach();
    return queue;
}

std::optional<Incoming> MessageQueue::next() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
        if (waiting_.empty()) return std::nullopt;
        Incoming message = std::move(waiting_.front());
        waiting_.pop_front();
        waiting_bytes_ -= message.bytes;
        changed_.notify_all();
        if (message.cancelled) continue;
        // The message runs from here on: a cancellation finds it among those that wait, or running.
        const auto id = message.message.is_object() ? message.message.find("id") : message.message.end();
        running_ = id != message.message.end() ? *id : nlohmann::json();
        cancelled_ = false;
        return message;
    }
}

void MessageQueue::begin_call(const nlohmann::json& id) {
    const std::lock_guard lock(mutex_);
    if (running_ == id) return;  // since next()
    running_ = id;
    cancelled_ = false;
}

void MessageQueue::end_call() {
    const std::lock_guard lock(mutex_);
    running_ = nullptr;
}

void MessageQueue::push(Incoming message) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting && waiting_bytes_ < kMostWaitingBytes; });
    waiting_bytes_ += message.bytes;
    waiting_.push_back(std::move(message));
    changed_.notify_all();
}

void MessageQueue::cancel(const nlohmann::json& notification) {
    const auto params = notification.find("params");
    if (params == notification.end() || !params->is_object()) return;
    const auto id = params->find("requestId");
    if (id == params->end() || id->is_null()) return;
    const std::lock_guard lock(mutex_);
    if (running_ == *id) cancelled_ = true;
    for (Incoming& message : waiting_) {
        const auto has = message.message.is_object() ? message.message.find("id") : message.message.end();
        if (has != message.message.end() && *has == *id) message.cancelled = true;
    }
}

void MessageQueue::take_line(std::string_view line) {
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    Incoming message = parse_message(line);
    if (message.message.is_object() && !message.message.contains("id")) {
        const auto method = message.message.find("method");
        if (method != message.message.end() && *method == "notifications/cancelled") cancel(message.message);
    }
    push(std::move(message));
}

void MessageQueue::read_all(platform::NativeHandle input) {
    std::array<char, 1 << 16> part;
    std::string line;
    bool too_long = false;  // the rest of the line is left out
    const auto end_line = [&] {
        if (too_long)
            push(parse_message(line));
        else
            take_line(line);
        line.clear();
        too_long = false;
    };
    for (;;) {
        const std::ptrdiff_t got = platform::read_some(input, part.data(), part.size());
        if (got <= 0) break;
        std::string_view rest(part.data(), static_cast<std::size_t>(got));
        while (!rest.empty()) {
            const std::size_t end = rest.find('\n');
            if (!too_long) line.append(rest.substr(0, std::min({end, rest.size(), kMostMessageBytes + 1 - line.size()})));
            too_long |= line.size() > kMostMessageBytes;
            if (end == std::string_view::npos) break;
            end_line();
            rest.remove_prefix(end + 1);
        }
    }
    end_line();
}

void MessageQueue::end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
}

}  // namespace halflit::cli
