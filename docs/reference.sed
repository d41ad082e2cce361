# Doxygen reads the headers through this (sed -E), so that they stay compact as source. Line numbers stay the same.

# A header's opening comment describes the file. The line that this adds is that of "#pragma once".
1s|^// (.*)|//! @file\n//! \1|
2,/^#/s|^//|//!|
/^#pragma once$/d

# What is `= default` needs no description.
s/^.* = default;.*//

# Members and functions of the C interface that mean the same everywhere.
s|^    size_t size;$|&  ///< size of the struct in the program that calls, see the _init function|
s|^    int32_t reserved;$|&  ///< 0|
s|^HALFLIT_C_API int32_t halflit_[a-z_]+_init\(|/** Sets the defaults, and the struct's size to `size`, which is sizeof of the struct. */ &|

# `int width = 0, height = 0;  ///< pixels` describes both.
:split
s|^((.* \*/)? *)([A-Za-z][A-Za-z0-9_:<>]*) ([a-z0-9_]+(\[[0-9]+\])?( = [^,;{]+)?(\{[^{}]*\})?), ([^;]*;) +///< (.*)$|\1\3 \4; /**< \9 */ \3 \8  ///< \9|
t split
