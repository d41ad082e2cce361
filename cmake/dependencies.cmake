# Libraries that halflit is made of. This is the only list of them: the project and its installed package find them here, and `./dev` takes
# the names of Debian's packages from it.
#   halflit_find(NAME)               sets NAME_found, NAME_target, NAME_flags (for the linker), and NAME_problem, a sentence, where it is
#                                    not found or too old
#   halflit_need(NAMES...)           the same; ends the configuration where one is not found, with halflit_need_note
#   halflit_want(NAME "what goes")   the same; says what is left out where it is not found

# HOW is one of
#   find_package PACKAGE       CMake's own search
#   pkg-config MODULES...      the version is that of the first module
#   header FILE EXPRESSION...  the version's parts are what each regular expression matches in the file
# OLDEST and TESTED: versions that are known to work, and were tested last. A newer one is used with a warning. `any`: it tells none.
# USE is raster, io, program, viewer, cad, tests or bench; of several uses, the first.
#    NAME          USE     OLDEST TESTED  DEBIAN'S PACKAGE     TARGET                HOW
set(halflit_rows
    "xsimd         raster  8.1    14.3    libxsimd-dev halflit::xsimd header xsimd/config/xsimd_config.hpp MAJOR.([0-9]+) MINOR.([0-9]+)"
    "tl-expected   raster  1.0    1.3.1   libexpected-dev      tl::expected          find_package tl-expected"
    "fmt           io      9.1    11.1.1  libfmt-dev           fmt::fmt              find_package fmt"
    "libjpeg       io      2.1    3.1.3   libjpeg62-turbo-dev  PkgConfig::libjpeg    pkg-config libjpeg"
    "spng          io      0.7.3  0.7.4   libspng-dev          PkgConfig::spng       pkg-config spng"
    "libdeflate    io      1.14   1.25    libdeflate-dev       PkgConfig::libdeflate pkg-config libdeflate"
    "stb           io      1.16   1.16    libstb-dev           halflit::stb          header stb/stb_image_write.h v([0-9]+.[0-9]+)"
    "OpenEXR       io      3.1    3.4.16  libopenexr-dev       PkgConfig::OpenEXR    pkg-config OpenEXR"
    "expat         io      2.5    2.9.0   libexpat1-dev        PkgConfig::expat      pkg-config expat"
    "Draco         io      1.5.5  1.5.7   libdraco-dev         PkgConfig::Draco      pkg-config draco"
    "meshoptimizer io      0.18   0.22    libmeshoptimizer-dev meshoptimizer::meshoptimizer find_package meshoptimizer"
    "libwebp       io      1.2.4  1.6.0   libwebp-dev          PkgConfig::libwebp    pkg-config libwebp"
    "zstd          io      1.5    1.5.7   libzstd-dev          PkgConfig::zstd       pkg-config libzstd"
    "CLI11         program 2.1.2  2.6.1   libcli11-dev         CLI11::CLI11          find_package CLI11"
    "nlohmann_json program 3.11   3.12    nlohmann-json3-dev   nlohmann_json::nlohmann_json find_package nlohmann_json"
    "GIF           program 5.1    6.1.3   libgif-dev           GIF::GIF              find_package GIF"
    "libwebpmux    program 1.2.4  1.6.0   libwebp-dev          PkgConfig::libwebpmux pkg-config libwebpmux libwebp"
    "SDL2          viewer  2.0.18 2.32.74 libsdl2-dev          PkgConfig::SDL2       pkg-config sdl2"
    "imgui         viewer  1.86   1.92.2  libimgui-dev         PkgConfig::imgui      pkg-config imgui"
    "OpenCASCADE   cad     7.6    7.6.3   libocct-data-exchange-dev halflit::occt header Standard_Version.hxx COMPLETE[^0-9:/]+([0-9.]+)"
    "Catch2        tests   2.13   3.7.1   catch2               Catch2::Catch2        find_package Catch2"
    "tinygltf      tests   any    any     libtinygltf-dev      halflit::tinygltf     header tiny_gltf.h"
    "libwebpdemux  tests   1.2.4  1.6.0   libwebp-dev          PkgConfig::libwebpdemux pkg-config libwebpdemux"
    "benchmark     bench   1.7    1.9.1   libbenchmark-dev     benchmark::benchmark  find_package benchmark"
)

# Each sets version and flags, where the library is there.
macro(halflit_find_by_find_package package)
    set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
    find_package(${package} QUIET)
    set(version "${${package}_VERSION}")
    set(flags -l${package})
    if("${${package}_LIBRARIES}" MATCHES "/lib([^/]+)\\.(so|a|dylib)$")
        set(flags -l${CMAKE_MATCH_1})
    endif()
endmacro()

macro(halflit_find_by_pkg-config module)
    find_package(PkgConfig QUIET)
    if(PkgConfig_FOUND)
        pkg_check_modules(${name} QUIET IMPORTED_TARGET GLOBAL ${module} ${ARGN})
        set(version "${${name}_VERSION}")
        if(NOT version)
            set(version "${${name}_${module}_VERSION}")  # of several modules
        endif()
        set(flags ${${name}_LDFLAGS})
        if(TARGET ${target})
            # Some modules give folders relative to a prefix that they do not name (Draco's in Debian 13).
            get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
            if(folders)
                list(FILTER folders INCLUDE REGEX "^/|^[A-Za-z]:")
                set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${folders}")
            endif()
        endif()
    endif()
endmacro()

macro(halflit_find_by_header file)
    find_path(HALFLIT_${name}_FOLDER ${file} HINTS ${CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES} PATH_SUFFIXES opencascade)
    mark_as_advanced(HALFLIT_${name}_FOLDER)
    if(HALFLIT_${name}_FOLDER)
        file(READ ${HALFLIT_${name}_FOLDER}/${file} text LIMIT 4096)
        set(parts "")
        foreach(expression ${ARGN})
            string(REGEX MATCH "${expression}" part "${text}")
            list(APPEND parts "${CMAKE_MATCH_1}")
        endforeach()
        list(JOIN parts "." version)
        if(NOT TARGET ${target})
            add_library(${target} INTERFACE IMPORTED GLOBAL)
            set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${HALFLIT_${name}_FOLDER})
        endif()
    endif()
endmacro()

function(halflit_find name)
    set(row ${halflit_rows})
    list(FILTER row INCLUDE REGEX "^${name} ")
    if(NOT row)
        message(FATAL_ERROR "cmake/dependencies.cmake has no row for ${name}")
    endif()
    string(REGEX REPLACE " +" ";" row "${row}")
    list(POP_FRONT row unused use oldest tested package target how)
    set(version "")
    set(flags "")
    cmake_language(CALL halflit_find_by_${how} ${row})
    set(problem "")
    if(NOT TARGET ${target})
        set(problem "${name} was not found: expected ${oldest} or newer (Debian's package ${package})")
    elseif(version AND version VERSION_LESS oldest)
        set(problem "${name} ${version} is too old: expected ${oldest} or newer (Debian's package ${package})")
    elseif(version VERSION_GREATER tested AND NOT version MATCHES "^${tested}\\." AND NOT HALFLIT_${name}_NEWER)
        message(STATUS "halflit: ${name} ${version} is newer than ${tested}, the last one that was tested")
        set(HALFLIT_${name}_NEWER ${version} CACHE INTERNAL "")
    endif()
    set(${name}_problem "${problem}" PARENT_SCOPE)
    set(CMAKE_MODULE_PATH "${CMAKE_MODULE_PATH}" PARENT_SCOPE)  # Catch2 adds to it
    set(${name}_target ${target} PARENT_SCOPE)
    set(${name}_flags ${flags} PARENT_SCOPE)
    set(${name}_found OFF PARENT_SCOPE)
    if(NOT problem)
        set(${name}_found ON PARENT_SCOPE)
        set_property(GLOBAL APPEND PROPERTY HALFLIT_LIBRARIES ${name})
        if(use MATCHES "raster|io|program|viewer")
            set_property(GLOBAL APPEND PROPERTY HALFLIT_LIBRARY_VERSIONS "${name} ${version}")
        endif()
    endif()
endfunction()

macro(halflit_need)
    set(halflit_problems "")
    foreach(halflit_library IN ITEMS ${ARGN})
        halflit_find(${halflit_library})
        if(${halflit_library}_problem)
            string(APPEND halflit_problems "halflit: ${${halflit_library}_problem}\n")
        endif()
    endforeach()
    if(halflit_problems)
        message(FATAL_ERROR "${halflit_problems}${halflit_need_note}")
    endif()
endmacro()

macro(halflit_want library without)
    halflit_find(${library})
    if(${library}_problem)
        message(STATUS "halflit: ${${library}_problem}; ${without}")
    endif()
endmacro()
