#include "apps/io/files/load_failure.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {

void refuse(std::string_view where, std::string_view what, ErrorCode code) {
    throw LoadFailure{{code, fmt::format("{}{}{}", where, where.empty() ? "" : ": ", what)}};
}

void Budget::take(std::uint64_t bytes) {
    if (bytes > left())
        refuse("", fmt::format("{} would take more than {} MB, which is the limit for a file of this size", what_, limit_ >> 20),
               ErrorCode::limit);
    used_ += bytes;
}

}  // namespace halflit::io::detail
