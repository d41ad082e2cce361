# Flags that decide values (CONTRIBUTING.md, "The numerics contract"), and a check that the compiler follows them.
#   HALFLIT_VALUE_FLAGS  flags of every source of ours
include(CheckCXXSourceCompiles)

# Contraction into fused multiply-add is off because it rounds once where the source rounds twice, on some instruction sets only. GCC 12
# drops the rounding of double to float and back where it vectorises straight-line code (SLP), as in {double(float(x)), double(float(y)),
# double(float(z))}; tests/sh/rounding_test.cpp.
set(HALFLIT_VALUE_FLAGS -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND HALFLIT_VALUE_FLAGS -fno-tree-slp-vectorize)
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(i[3-6]86|x86|x86_64|AMD64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 4)
    list(APPEND HALFLIT_VALUE_FLAGS -msse2 -mfpmath=sse)
    message(STATUS "halflit: 32-bit x86: compiled with -msse2 -mfpmath=sse, since x87's precision would change pixels")
endif()
list(APPEND HALFLIT_VALUE_FLAGS "SHELL:-include \"${PROJECT_SOURCE_DIR}/sh/value_flags.hpp\"")

# Old libc++ lacks parts of the standard library.
check_cxx_source_compiles("
#include <charconv>
#include <thread>
int main() {
    const char text[] = \"1.5\";
    float value = 0;
    std::from_chars(text, text + 3, value);
    double wide = 0;
    std::from_chars(text, text + 3, wide);
    std::jthread thread([] {});
    return value == 1.5f ? 0 : 1;
}" HALFLIT_LIBRARY_IS_WHOLE)
if(NOT HALFLIT_LIBRARY_IS_WHOLE)
    list(APPEND HALFLIT_VALUE_FLAGS "SHELL:-include \"${PROJECT_SOURCE_DIR}/sh/missing_library.hpp\"")
endif()

# A compiler may ignore a flag without an error. So a small program is compiled as our sources are, and run where it can run; and its fused
# operations are looked for, with the flag that allows them where the processor's base has none. Once for each compiler and its flags.
set(probe_flags ${HALFLIT_VALUE_FLAGS})
list(TRANSFORM probe_flags REPLACE "^SHELL:" "")
list(JOIN probe_flags " " probe_flags)
string(TOUPPER "${CMAKE_BUILD_TYPE}" probe_type)
set(probe ${CMAKE_CURRENT_LIST_DIR}/value_probe.cpp)
file(SHA1 ${probe} probe_hash)
string(SHA1 probe_key "${CMAKE_CXX_COMPILER} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${probe_type}}
    ${probe_flags} ${CMAKE_EXE_LINKER_FLAGS} ${probe_hash}")
if(NOT HALFLIT_VALUE_PROBE STREQUAL probe_key)
    set(CMAKE_TRY_COMPILE_CONFIGURATION ${CMAKE_BUILD_TYPE})
    set(probe_folder ${PROJECT_BINARY_DIR}/CMakeFiles/value_probe)
    set(probe_may_fuse "")
    set(probe_link "")
    if(EMSCRIPTEN)
        set(probe_link LINK_OPTIONS -sSINGLE_FILE=1)  # one file is copied, not the code beside it
    endif()
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|^i[3-6]86$" AND NOT EMSCRIPTEN)
        set(probe_may_fuse -mfma)
    endif()
    try_compile(probe_compiles ${probe_folder}/plain ${probe} COMPILE_DEFINITIONS "${probe_flags}" ${probe_link}
        CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON OUTPUT_VARIABLE probe_output COPY_FILE ${probe_folder}/plain_probe)
    if(NOT probe_compiles)
        if(probe_output MATCHES "(halflit: [^\n\"]*)")
            message(FATAL_ERROR "${CMAKE_MATCH_1}")
        endif()
        message(FATAL_ERROR "halflit: the compiler does not compile cmake/value_probe.cpp:\n${probe_output}")
    endif()
    try_compile(probe_compiles ${probe_folder}/fused ${probe} COMPILE_DEFINITIONS "${probe_flags} ${probe_may_fuse}"
        CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON OUTPUT_VARIABLE probe_output COPY_FILE ${probe_folder}/fused_probe)
    set(probe_code "")
    if(probe_compiles AND CMAKE_OBJDUMP AND NOT EMSCRIPTEN)
        execute_process(COMMAND ${CMAKE_OBJDUMP} -d ${probe_folder}/fused_probe OUTPUT_VARIABLE probe_code ERROR_QUIET)
        string(REGEX MATCH "<_?halflit_multiply_add[^\n>]*>:\n([^\n]+\n)+" probe_code "${probe_code}")
    endif()
    # Names of fused operations: vfmadd (x86), fmadd, fmla (Arm), vfma (32-bit Arm), fmadd (RISC-V), fmadds, xsmadd (POWER), maebr,
    # wfma (Z).
    if(probe_code MATCHES "[ \t]((v?fn?m(add|sub|la|ls)|vfn?m[as]|x[sv]n?m(add|sub)|m[as][ed]br|wfn?m[as])[a-z0-9.]*)[ \t]")
        message(FATAL_ERROR "halflit: the compiler fuses multiplications and additions (${CMAKE_MATCH_1}) in spite of -ffp-contract=off, "
            "which changes pixels")
    endif()
    set(probe_result 0)
    set(probe_runs OFF)
    if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR)
        set(probe_runs ON)
        execute_process(COMMAND ${CMAKE_CROSSCOMPILING_EMULATOR} ${probe_folder}/plain_probe RESULT_VARIABLE probe_result
            OUTPUT_VARIABLE probe_output)
        if(NOT probe_result MATCHES "^-?[0-9]+$" AND CMAKE_CROSSCOMPILING)  # there is no emulator
            set(probe_result 0)
            set(probe_runs OFF)
        endif()
    endif()
    if(NOT probe_result EQUAL 0)
        message(FATAL_ERROR "halflit: the compiler's arithmetic would change pixels: ${probe_output} (cmake/value_probe.cpp)")
    elseif(NOT probe_code AND NOT probe_runs)
        message(WARNING "halflit: the compiler's arithmetic could not be checked: run cmake/value_probe.cpp on the target machine")
    endif()
    set(HALFLIT_VALUE_PROBE ${probe_key} CACHE INTERNAL "Compiler and flags whose arithmetic was checked")
endif()
