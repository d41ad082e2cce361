// Sample for the layering test: a third-party type in a public header.
#include <tbb/parallel_for.h>
