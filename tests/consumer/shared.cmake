# Builds and installs the shared libraries, looks at the names that they show, and runs consumers of each component.
#   cmake -DSOURCE=tree -DWORK=folder -DCOMPILER=c++ -DC_COMPILER=cc -DMAKE_PROGRAM=ninja [-DLAUNCHER=ccache] [-DPYTHON=python3] -DNM=nm
#         -P shared.cmake
set(here ${CMAKE_CURRENT_LIST_DIR})
include(${here}/run_command.cmake)

set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK}/consumer)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O0
    -DHALFLIT_SHARED=ON -DHALFLIT_KERNEL_SETS=scalar -DHALFLIT_BUILD_APPS=OFF -DHALFLIT_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${CMAKE_COMMAND} --install ${WORK}/build --prefix ${prefix})

# Only public names are visible.
file(GLOB_RECURSE libraries ${prefix}/*/libhalflit*.so)
list(LENGTH libraries count)
if(NOT count EQUAL 3)
    message(FATAL_ERROR "expected three shared libraries, found ${libraries}")
endif()
foreach(library IN LISTS libraries)
    run(${NM} -D --defined-only --demangle ${library})
    string(REGEX REPLACE "[][;]" " " output "${output}")
    string(REGEX MATCHALL "[^\n]+" lines "${output}")
    foreach(line IN LISTS lines)
        if(NOT line MATCHES "^[0-9a-f]+ [TDBRVW] (halflit_[a-z0-9_]+|halflit::.*)$" OR
           line MATCHES "halflit::(sh|shading|raster|io|engine|film|c|cli)::")
            message(FATAL_ERROR "${library} shows ${line}")
        endif()
    endforeach()
endforeach()

# Each component by find_package, and the C interface by pkg-config and by Python.
run(${CMAKE_COMMAND} -S ${here} -B ${WORK}/consumer -G Ninja -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DWAY=find_package -DCOMPONENTS=raster,io,c -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)
run(${WORK}/consumer/consumer_of_files)
file(GLOB_RECURSE files ${prefix}/*/halflit-c.pc)
get_filename_component(folder ${files} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND pkg-config --cflags --libs halflit-c OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
    COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${C_COMPILER} -std=c99 -pedantic -Wall -Wextra -Werror ${SOURCE}/apps/examples/cube.c ${flags} -o ${WORK}/cube)
get_filename_component(library_folder ${folder} DIRECTORY)
set(ENV{LD_LIBRARY_PATH} ${library_folder})
run(${WORK}/cube ${WORK}/cube.png)
unset(ENV{LD_LIBRARY_PATH})
if(PYTHON)
    run(${PYTHON} ${SOURCE}/tests/c/cube.py ${library_folder}/libhalflit_c.so)
    message(STATUS "Python's cube: ${output}")
endif()
