# Toolchain for Windows: Debian's mingw-w64, and wine to run programs. `./dev test --windows` and `./dev package --windows` use it.
#   apt-get install g++-mingw-w64-x86-64-posix wine64
#   HALFLIT_PREFIX   folder with the static libraries that portable/libraries.sh has made; without it only the core can be built
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HALFLIT_PREFIX)
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
# unaligned-vector-move: GCC aligns the stack to 16 bytes there, and moves registers of 32 bytes to it as if it were aligned to 32 (GCC bug
# 54412). The assembler makes moves of them that need no alignment.
# no-ipa-ra: otherwise GCC keeps values in registers that an inline function leaves alone as it was compiled here, where the linker may take
# another object's copy, which does not. _WIN32_WINNT: Windows 10, whose functions are declared.
set(common "-Wa,-muse-unaligned-vector-move -fno-ipa-ra -D_WIN32_WINNT=0x0A00 -D__USE_MINGW_ANSI_STDIO=1")
set(CMAKE_C_FLAGS_INIT "${common}")
set(CMAKE_CXX_FLAGS_INIT "${common}")
# Programs and libraries need no library of the compiler beside them.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-static")
set(CMAKE_MODULE_LINKER_FLAGS_INIT "-static")
set(CMAKE_FIND_ROOT_PATH ${HALFLIT_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} ${HALFLIT_PREFIX}/lib/pkgconfig)  # not the build machine's libraries
set(PKG_CONFIG_ARGN --static)
find_program(HALFLIT_WINE NAMES wine64 wine PATHS /usr/lib/wine)
if(HALFLIT_WINE)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${HALFLIT_WINE})
endif()
include(${CMAKE_CURRENT_LIST_DIR}/header_only.cmake)
