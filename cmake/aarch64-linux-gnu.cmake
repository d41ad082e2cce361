# Toolchain for 64-bit Arm Linux: Debian's cross-compiler, and qemu to run the programs. `dev test --aarch64` uses it.
#   apt-get install g++-aarch64-linux-gnu qemu-user
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64;-L;/usr/aarch64-linux-gnu")
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig)  # not the build machine's libraries

# Header-only libraries are the same for all processors, but the build machine's /usr/include also has headers that are not. So this folder
# has links to those libraries alone.
set(header_links ${CMAKE_BINARY_DIR}/header-only)
foreach(folder xsimd tl catch2)
    if(EXISTS /usr/include/${folder} AND NOT EXISTS ${header_links}/${folder})
        file(MAKE_DIRECTORY ${header_links})
        file(CREATE_LINK /usr/include/${folder} ${header_links}/${folder} SYMBOLIC)
    endif()
endforeach()
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${header_links})
