#include "apps/io/platform/child.hpp"

namespace halflit::platform {

bool can_run_children() { return false; }

ChildResult run_confined(const std::vector<std::string>& /*words*/, std::span<const std::byte> /*input*/, const ChildLimits& /*limits*/) {
    return {};
}

std::string own_folder() { return {}; }

}  // namespace halflit::platform
