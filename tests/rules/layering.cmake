# Rules about sources that no compiler checks. Includes point left only, among layers and among the subfolders of a layer. Public headers,
# those in a folder include/halflit, include nothing but each other, the standard library and tl::expected. Only the vocabulary names xsimd
# and intrinsics. Kernels call nothing whose result depends on the machine.
#   cmake -DROOT=source-tree -P layering.cmake
cmake_minimum_required(VERSION 3.25)
set(layers sh shading raster apps)
# Functions of the standard library that a kernel must not call.
string(CONCAT library_function "std::(sqrt|pow|exp2?|log2?|sin|cos|tan|atan2?|acos|asin|fma|floor|ceil|round|nearbyint|l?lrint"
    "|fabs|abs|min|max|clamp|hypot)[^a-z0-9_]")
# Functions of the C library whose last bits differ. What draws or decides has its own (sh/trig.hpp, sh/power.hpp); the reference, which
# --accuracy reference and tests compare with, and measures of lobes for people to read have not.
string(CONCAT libm_function "(std::|[^a-z0-9_:.>]|__builtin_)(exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot|sin|cos|tan"
    "|asin|acos|atan|atan2|sinh|cosh|tanh|erf|tgamma|lgamma)f?l?\\(")
set(estimate "(rsqrt|reciprocal|rcp14|rcp_ps|f?n?m[as][dc]d?_ps|xsimd::f?n?m[as])")
set(vector_name "xsimd|[^a-z]_mm(256|512)?_|[ix]mmintrin|arm_neon")
set(by_libm "^(shading/reference/|raster/passes/reference_shading|sh/lobe_error\\.cpp)")
# Subfolders of a layer, with the includes that a file of each must not have.
set(subfolders
    "shading/model/=shading/((plan|budget|reference|kernels)/|planner)"
    "shading/plan/=shading/((budget|reference|kernels)/|planner)"
    "shading/budget/=shading/((reference|kernels)/|planner)"
    "shading/kernels/=shading/((budget|reference)/|planner)"
    "shading/reference/=shading/((budget|kernels)/|planner)"
    "raster/kernels/=raster/((scene|view|passes|built_in|detail)/|[a-z_]+.hpp)"
    "raster/detail/=raster/((scene|view|passes|built_in|kernels)/|renderer|frame_plan)"
    "raster/scene/=raster/((geometry|view|passes|choice|explain|built_in)/|renderer|frame_plan)"
    "raster/geometry/=raster/((view|passes|choice|explain|built_in|kernels)/|renderer|frame_plan)"
    "raster/view/=raster/((passes|choice|explain|built_in)/|renderer|frame_plan)"
    "raster/passes/=raster/((choice|explain|built_in)/|renderer)"
    "raster/fixed/=raster/((choice|explain|built_in)/|renderer|frame_plan)"
    "raster/choice/=raster/((passes|explain|kernels)/|renderer|frame_plan)"
    "raster/explain/=raster/((geometry|passes|choice|built_in|kernels)/|renderer|frame_plan)"
    "raster/built_in/=raster/((geometry|view|passes|choice|explain|kernels)/|renderer|frame_plan)"
    "apps/io/platform/=apps/io/(files|pictures|gltf|models)/"
    "apps/io/files/=apps/io/(codecs|pictures|gltf|models)/"
    "apps/io/codecs/=apps/io/(files|pictures|gltf|models)/"
    "apps/io/pictures/=apps/io/(gltf|models)/"
    "apps/io/gltf/=apps/io/models/"
    "apps/io/gltf/text/=apps/io/(gltf/(file|codecs|build|animation)|models)/"
    "apps/io/gltf/file/=apps/io/(gltf/(codecs|build|animation)|models)/"
    "apps/io/gltf/codecs/=apps/io/(gltf/(build|animation)|models)/"
    "apps/io/gltf/build/=apps/io/(gltf/animation|models)/"
    "apps/engine/basics/=apps/engine/(film|request|job|pictures|answers|look|compare|calls|trade)/"
    "apps/engine/film/=apps/engine/(basics|request|job|pictures|answers|look|compare|calls|trade)/"
    "apps/engine/request/=apps/engine/(job|pictures|answers|look|compare|calls|trade)/"
    "apps/engine/job/=apps/engine/(pictures|answers|look|compare|calls|trade)/"
    "apps/engine/pictures/=apps/engine/(answers|look|compare|calls|trade)/"
    "apps/engine/answers/=apps/engine/(look|compare|calls|trade)/"
    "apps/engine/look/=apps/engine/(compare|calls|trade)/"
    "apps/engine/compare/=apps/engine/(calls|trade)/"
    "apps/engine/mujoco/=apps/engine/(basics|film|request|job|pictures|answers|look|compare|calls|trade)/"
    "apps/halflit/program/=apps/(halflit/(flags|farm|golden|mcp|commands)|lab|viewer)/"
    "apps/halflit/flags/=apps/(halflit/(farm|golden|mcp|commands)|lab|viewer)/"
    "apps/halflit/farm/=apps/(halflit/(golden|mcp|commands)|lab|viewer)/"
    "apps/halflit/golden/=apps/(halflit/(farm|mcp|commands)|lab|viewer)/"
    "apps/halflit/mcp/=apps/(halflit/(golden|commands)|lab|viewer)/"
    # The C interface and all that stands on io know what is public and what program and library share.
    "apps/io/=apps/(engine|c|halflit|viewer|lab|web|npm)/"
    "apps/engine/=apps/(c|halflit|viewer|lab|web|npm)/"
    "apps/c/=apps/(halflit|viewer|lab|web|npm)/"
    "apps/lab/=apps/(c|viewer|web|npm)/"
    "apps/viewer/=apps/(c|halflit|lab|web|npm)/"
    "apps/web/=apps/(c|halflit|lab|npm)/")
set(failures "")
set(file_count 0)

# The layer of each public header, for includes by "halflit/NAME.hpp".
foreach(layer IN LISTS layers)
    file(GLOB_RECURSE headers ${ROOT}/${layer}/*.hpp ${ROOT}/${layer}/*.h)
    foreach(header IN LISTS headers)
        if(header MATCHES "/include/(halflit/[a-z_]+\\.hp?p?)$")
            string(MAKE_C_IDENTIFIER "${CMAKE_MATCH_1}" key)
            set(layer_of_${key} ${layer})
        endif()
    endforeach()
endforeach()

# Reads the lines of a file into a list, without what follows //. Semicolons and brackets are replaced: they would break a CMake list.
function(read_code file out)
    file(READ ${file} text)
    string(REGEX REPLACE "[][;]" " " text "${text}")
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REPLACE "\n" ";" lines "${text}")
    set(${out} "${lines}" PARENT_SCOPE)
endfunction()

foreach(layer IN LISTS layers)
    string(REGEX REPLACE "^(.*\\|)?${layer}(\\||$)" "" forbidden "sh|shading|raster|apps")  # the layers to the right
    file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${layer}/*.hpp ${ROOT}/${layer}/*.cpp)
    foreach(file IN LISTS files)
        math(EXPR file_count "${file_count} + 1")
        read_code(${ROOT}/${file} lines)
        set(in_vocabulary FALSE)
        set(in_kernel FALSE)
        set(public FALSE)
        set(other_subfolders "")
        foreach(subfolder IN LISTS subfolders)
            string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${subfolder}")
            if(file MATCHES "^${CMAKE_MATCH_1}")
                string(REGEX REPLACE "^[^=]*=" "" others "${subfolder}")
                list(APPEND other_subfolders "${others}")
            endif()
        endforeach()
        list(JOIN other_subfolders "|" other_subfolders)
        if(file MATCHES "^shading/kernels/simd[a-z_]*\\.hpp$")
            set(in_vocabulary TRUE)
        elseif(file MATCHES "^(shading|raster)/kernels/" AND NOT file MATCHES "/(registry\\.cpp|isa(_select)?\\.hpp)$")
            set(in_kernel TRUE)
        elseif(file MATCHES "/include/halflit/")
            set(public TRUE)
        endif()
        # Lines that a rule may be about: the others take most of the time.
        list(FILTER lines INCLUDE REGEX "#include|${vector_name}|${estimate}|${library_function}|${libm_function}")
        foreach(line IN LISTS lines)
            if(line MATCHES "^ *#include [<\"](halflit/[a-z_]+\\.hp?p?)[>\"]")
                string(MAKE_C_IDENTIFIER "${CMAKE_MATCH_1}" key)
                set(included_layer "${layer_of_${key}}")
                if(forbidden AND included_layer AND included_layer MATCHES "^(${forbidden})$")
                    list(APPEND failures "${file}: include points right: ${line}")
                endif()
            elseif(public AND line MATCHES "^ *#include" AND NOT line MATCHES "#include <([a-z_]+|tl/expected\\.hpp|std[a-z]+\\.h)>")
                list(APPEND failures "${file}: third-party or internal header in a public header: ${line}")
            endif()
            if(forbidden AND line MATCHES "^ *#include \"(${forbidden})/")
                list(APPEND failures "${file}: include points right: ${line}")
            endif()
            if(other_subfolders AND line MATCHES "^ *#include \"(${other_subfolders})")
                list(APPEND failures "${file}: include points into a subfolder to the right: ${line}")
            endif()
            if(line MATCHES "^ *#include \"(bench|tests)/")
                list(APPEND failures "${file}: include points out of the layers: ${line}")
            endif()
            if(file STREQUAL "sh/fp_environment.hpp")
                # The one place that sets the processor's floating-point control register.
                string(REGEX REPLACE "_mm_[gs]etcsr|xmmintrin" "" line "${line}")
            endif()
            if(layer MATCHES "^(sh|shading|raster)$" AND NOT file MATCHES "${by_libm}" AND line MATCHES "${libm_function}")
                list(APPEND failures "${file}: the C library's last bits differ among machines, and may turn a decision: ${line}")
            endif()
            if(NOT in_vocabulary AND line MATCHES "${vector_name}")
                list(APPEND failures "${file}: vector instructions are named in shading/kernels/simd*.hpp only: ${line}")
            endif()
            if((in_kernel OR in_vocabulary) AND line MATCHES "#include <(cmath|math|algorithm|numeric|functional|complex)")
                list(APPEND failures "${file}: kernels use only their vocabulary: ${line}")
            endif()
            if((in_kernel OR in_vocabulary) AND line MATCHES "${library_function}")
                list(APPEND failures "${file}: not the same on every machine: ${line}")
            endif()
            if((in_kernel OR in_vocabulary) AND line MATCHES "${estimate}")
                list(APPEND failures "${file}: an estimate or a fused operation: ${line}")
            endif()
        endforeach()
    endforeach()
endforeach()
if(file_count LESS 3)
    message(FATAL_ERROR "only ${file_count} files found under ${ROOT}")
endif()
if(failures)
    list(JOIN failures "\n  " text)
    message(FATAL_ERROR "rules broken:\n  ${text}")
endif()
message(STATUS "${file_count} files keep the rules")
