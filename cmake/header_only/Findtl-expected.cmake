# tl::expected from the folder that the toolchain has in the compiler's path.
if(NOT TARGET tl::expected)
    add_library(tl::expected INTERFACE IMPORTED)
endif()
set(tl-expected_FOUND TRUE)
