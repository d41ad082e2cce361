# How the project's libraries are made.
#   halflit_flags                            the project's compiler flags and internal include folders; not for consumers
#   halflit_unity(TARGET GROUPS...)          sources of a target that are compiled together
#   halflit_layer(NAME SOURCES... UNITY...)  a static library halflit_NAME, one layer or component, with its public headers
#   halflit_component(NAME OUTPUT LAYERS...) the target halflit::NAME for consumers, made of layers, static or shared

add_library(halflit_flags INTERFACE)
target_compile_features(halflit_flags INTERFACE cxx_std_20)
include(${CMAKE_CURRENT_LIST_DIR}/value_flags.cmake)
target_compile_options(halflit_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:
    ${HALFLIT_VALUE_FLAGS}
    $<$<STREQUAL:$<CONFIG>,>:-O2>
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wno-bitwise-instead-of-logical>  # a scalar kernel's mask is a bool
    $<$<BOOL:${HALFLIT_WARNINGS_AS_ERRORS}>:-Werror>>)
target_link_libraries(halflit_flags INTERFACE halflit::xsimd)
target_include_directories(halflit_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
foreach(folder sh shading raster apps/io)
    target_include_directories(halflit_flags INTERFACE ${PROJECT_SOURCE_DIR}/${folder}/include)
endforeach()

# Some processors have no instruction for atomic bytes, and a library for them (riscv64 with GCC 12).
include(CheckCXXSourceCompiles)
set(atomic_bytes "#include <atomic>
#include <cstdint>
int main() { std::atomic<bool> a{false}; std::atomic<std::uint64_t> b{0}; return a.exchange(true) || ++b > 1; }")
check_cxx_source_compiles("${atomic_bytes}" HALFLIT_ATOMICS_ARE_BUILT_IN)
set(HALFLIT_ATOMIC_LIBRARY "")
if(NOT HALFLIT_ATOMICS_ARE_BUILT_IN)
    set(HALFLIT_ATOMIC_LIBRARY atomic)
endif()

# Adds sources to a target: GROUP a.cpp b.cpp.. GROUP c.cpp.. Those of a group are compiled together.
function(halflit_unity target)
    set(number 0)
    foreach(word IN LISTS ARGN)
        if(word STREQUAL "GROUP")
            math(EXPR number "${number} + 1")
        else()
            target_sources(${target} PRIVATE ${word})
            set_source_files_properties(${word} PROPERTIES UNITY_GROUP ${target}_${number})
        endif()
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${HALFLIT_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# UNITY: groups as for halflit_unity.
function(halflit_layer name)
    cmake_parse_arguments(arg "" "" "SOURCES;UNITY" ${ARGN})
    set(target halflit_${name})
    add_library(${target} STATIC ${arg_SOURCES})
    halflit_unity(${target} ${arg_UNITY})
    set_target_properties(${target} PROPERTIES
        CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
        POSITION_INDEPENDENT_CODE ON
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:halflit_flags>)
    target_compile_options(${target} PRIVATE ${HALFLIT_EXCEPTION_FLAGS})  # of the toolchain
    target_compile_features(${target} PUBLIC cxx_std_20)
    if(HALFLIT_SHARED)
        target_compile_definitions(${target} PRIVATE HALFLIT_BUILDING_SHARED)
    endif()
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_property(GLOBAL PROPERTY HALFLIT_HEADERS_${name} ${CMAKE_CURRENT_SOURCE_DIR}/include/halflit/)
endfunction()

# Objects of a layer that its own target does not list: the kernels.
function(halflit_add_objects name)
    target_sources(halflit_${name} PRIVATE ${ARGN})
    set_property(GLOBAL APPEND PROPERTY HALFLIT_OBJECTS_${name} ${ARGN})
endfunction()

# The folder of a program or a library itself, in the paths where it looks for others.
if(APPLE)
    set(HALFLIT_ORIGIN "@loader_path")
else()
    set(HALFLIT_ORIGIN "$ORIGIN")
endif()

# The target shows the names of a version script alone. Apple's linker takes a list of names, which begin with an underscore there.
function(halflit_show_names target script)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${script})
    if(NOT APPLE)
        target_link_options(${target} PRIVATE -Wl,--version-script=${script})
        return()
    endif()
    file(STRINGS ${script} names REGEX "^ +[a-zA-Z_].*;$")
    list(TRANSFORM names REPLACE "^ +(.*)$" "_\\1")
    string(REGEX REPLACE ";+" "\n" names "${names}")
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}.exported)
    file(CONFIGURE OUTPUT ${list} CONTENT "${names}\n" @ONLY)
    target_link_options(${target} PRIVATE -Wl,-exported_symbols_list,${list})
endfunction()

# Static: halflit::NAME is the last of its layers. Shared: a library lib<OUTPUT>.so of all its layers' objects, of which only the names that
# NAMES lists are visible (default: cmake/exported.map).
function(halflit_component name output)
    cmake_parse_arguments(arg "" "" "LAYERS;NEEDS;PRIVATE;NAMES" ${ARGN})
    list(GET arg_LAYERS -1 last)
    if(NOT HALFLIT_SHARED)
        add_library(halflit::${name} ALIAS halflit_${last})
        set_property(GLOBAL APPEND PROPERTY HALFLIT_COMPONENTS ${name})
        foreach(layer IN LISTS arg_LAYERS)
            set_property(GLOBAL APPEND PROPERTY HALFLIT_TARGETS_${name} halflit_${layer})
            set_target_properties(halflit_${layer} PROPERTIES EXPORT_NAME ${layer})
        endforeach()
        return()
    endif()
    set(target halflit_${name}_shared)
    set(objects "")
    foreach(layer IN LISTS arg_LAYERS)
        get_property(kernels GLOBAL PROPERTY HALFLIT_OBJECTS_${layer})
        list(APPEND objects $<TARGET_OBJECTS:halflit_${layer}> ${kernels})
    endforeach()
    add_library(${target} SHARED ${objects})
    add_library(halflit::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES
        OUTPUT_NAME ${output} LINKER_LANGUAGE CXX EXPORT_NAME ${name}
        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
        INSTALL_RPATH "${HALFLIT_ORIGIN}")
    if(NOT arg_NAMES)
        set(arg_NAMES ${PROJECT_SOURCE_DIR}/cmake/exported.map)
    endif()
    halflit_show_names(${target} ${arg_NAMES})
    if(NOT APPLE)
        target_link_options(${target} PRIVATE -Wl,--no-undefined)
    endif()
    target_link_libraries(${target} PUBLIC ${arg_NEEDS} PRIVATE ${arg_PRIVATE})
    target_compile_features(${target} PUBLIC cxx_std_20)
    foreach(layer IN LISTS arg_LAYERS)
        get_target_property(folders halflit_${layer} INTERFACE_INCLUDE_DIRECTORIES)
        target_include_directories(${target} PUBLIC ${folders})
    endforeach()
    set_property(GLOBAL APPEND PROPERTY HALFLIT_COMPONENTS ${name})
    set_property(GLOBAL APPEND PROPERTY HALFLIT_TARGETS_${name} ${target})
endfunction()
