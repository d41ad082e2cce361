// Marks what a shared library exports. Everything else in it is hidden.
#pragma once

/// Marks a function that programs may call.
#ifdef HALFLIT_BUILDING_SHARED
#define HALFLIT_API __attribute__((visibility("default")))
#else
#define HALFLIT_API
#endif
