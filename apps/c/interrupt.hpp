// The signal of Ctrl-C, which ends a frame.
#pragma once

namespace halflit::c {

/// While one lives, SIGINT sets a flag before the process's own handler runs. The last one puts that handler back.
class InterruptWatch {
public:
    /// is_wanted: otherwise it does nothing.
    explicit InterruptWatch(bool is_wanted);
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    /// The signal came since the first of those that live began.
    [[nodiscard]] static bool raised() noexcept;

private:
    bool is_wanted_;
};

}  // namespace halflit::c
