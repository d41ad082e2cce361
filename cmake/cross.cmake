# Toolchain for another processor under Debian: its cross compiler, the libraries of that architecture, and qemu to run programs.
# `./dev test --arch ARCH` uses it. HALFLIT_ARCH: Debian's name of the architecture.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HALFLIT_ARCH)
#    Debian    triplet                    processor  qemu     folder of libraries, where it is another
set(rows
    "arm64     aarch64-linux-gnu          aarch64    aarch64"
    "armhf     arm-linux-gnueabihf        armv7l     arm"
    "i386      i686-linux-gnu             i686       i386     i386-linux-gnu"
    "ppc64el   powerpc64le-linux-gnu      ppc64le    ppc64le"
    "riscv64   riscv64-linux-gnu          riscv64    riscv64"
    "s390x     s390x-linux-gnu            s390x      s390x")
list(FILTER rows INCLUDE REGEX "^${HALFLIT_ARCH} ")
if(NOT rows)
    message(FATAL_ERROR "HALFLIT_ARCH: expected arm64, armhf, i386, ppc64el, riscv64 or s390x, found '${HALFLIT_ARCH}'")
endif()
string(REGEX REPLACE " +" ";" rows "${rows}")
list(GET rows 1 triplet)
list(GET rows 2 CMAKE_SYSTEM_PROCESSOR)
list(GET rows 3 qemu)
list(GET rows -1 libraries)
if(libraries STREQUAL qemu)
    set(libraries ${triplet})
endif()
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_C_COMPILER ${triplet}-gcc)
set(CMAKE_CXX_COMPILER ${triplet}-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-${qemu})
if(NOT EXISTS /lib/${libraries}/libc.so.6)  # the cross compiler's own C library, where no package of the architecture is installed
    list(APPEND CMAKE_CROSSCOMPILING_EMULATOR -L /usr/${triplet})
endif()
set(CMAKE_LIBRARY_ARCHITECTURE ${libraries})
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/${libraries}/pkgconfig:/usr/share/pkgconfig)  # not the build machine's libraries
# Headers of packages that differ among architectures; Debian's cross compilers do not look there.
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES /usr/include/${libraries})
set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES /usr/include/${libraries})
