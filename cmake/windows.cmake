# Toolchain for Windows: Debian's mingw-w64, and wine to run programs. `./dev test --windows` uses it.
#   apt-get install g++-mingw-w64-x86-64-posix wine64
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")  # programs need no library of the compiler beside them
find_program(HALFLIT_WINE NAMES wine64 wine)
if(HALFLIT_WINE)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${HALFLIT_WINE})
endif()
include(${CMAKE_CURRENT_LIST_DIR}/header_only.cmake)
