// What a process may do that was started for a file of strangers.
#pragma once

#include <string>

namespace halflit::platform {

/// Descriptors of this file begin here, so that those of a child's streams, 0 to 3, can be put in their places.
inline constexpr int kLowestOwn = 10;

/// Made before fork(): what the child needs to give up its rights.
class Confinement {
public:
    /// program: its path. The folder that it is in stays readable.
    explicit Confinement(const std::string& program);
    ~Confinement();
    Confinement(const Confinement&) = delete;
    Confinement& operator=(const Confinement&) = delete;
    [[nodiscard]] int rules() const { return rules_; }

private:
    int rules_ = -1;  ///< of Landlock; -1: the kernel has none
};

/// Between fork and exec. What the kernel lacks is left out.
void confine(const Confinement& confinement);

/// Closes all descriptors from this one on.
void close_from(int first);

}  // namespace halflit::platform
