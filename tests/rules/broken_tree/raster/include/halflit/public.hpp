// Sample for the layering test: a third-party type in a public header.
#include <fmt/core.h>
