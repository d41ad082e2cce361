// Why a lobe's parameters are refused beyond their range, for messages.
#pragma once

#include "halflit/lobe.hpp"

namespace halflit::shading {

/// Reason why check_lobe refuses a wrap or a power, as ": reason"; empty where the range explains it.
[[nodiscard]] const char* why_not_wrap(double wrap);
[[nodiscard]] const char* why_not_power(double power);

}  // namespace halflit::shading
