# Builds and runs a consumer of the package, outside the tree.
#   cmake -DWAY=find_package|add_subdirectory|FetchContent|pkg-config -DSOURCE=tree -DBUILD=build-tree -DWORK=folder
#         [-DCOMPONENTS=raster;io] [-DCOMPILER=c++] [-DMAKE_PROGRAM=ninja] -P run.cmake
set(here ${CMAKE_CURRENT_LIST_DIR})
include(${here}/run_command.cmake)

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(prefix ${WORK}/prefix)
if(WAY MATCHES "find_package|pkg-config")
    run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
endif()
if(WAY STREQUAL "pkg-config")
    file(GLOB_RECURSE files ${prefix}/*.pc)
    list(GET files 0 file)
    get_filename_component(folder ${file} DIRECTORY)
    set(ENV{PKG_CONFIG_PATH} ${folder})
    execute_process(COMMAND pkg-config --cflags --libs halflit OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
        COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run(${COMPILER} -std=c++20 -O0 ${here}/consumer.cpp ${flags} -o ${WORK}/consumer)
    set(ENV{LD_LIBRARY_PATH} ${prefix}/lib:${prefix}/lib/x86_64-linux-gnu)
    run(${WORK}/consumer)
    message(STATUS "${output}")
    execute_process(COMMAND pkg-config --cflags --libs halflit-c OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
        COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run(${COMPILER} -x c -std=c99 ${here}/calls.c -x none ${flags} -o ${WORK}/calls)
    run(${WORK}/calls)
    message(STATUS "${output}")
    return()
endif()

set(optimisation "")
if(WAY STREQUAL "add_subdirectory")  # which compiles most
    set(optimisation -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
endif()
run(${CMAKE_COMMAND} -S ${here} -B ${WORK}/build -G Ninja -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -DCMAKE_CXX_COMPILER=${COMPILER}
    ${optimisation}
    -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DWAY=${WAY} "-DCOMPONENTS=${COMPONENTS}" -DCMAKE_PREFIX_PATH=${prefix}
    -DHALFLIT_SOURCE=${SOURCE} -DHALFLIT_KERNEL_SETS=scalar)
file(READ ${WORK}/build/compile_commands.json commands)
string(REGEX MATCHALL "\"command\": \"[^\"]*consumer\\.cpp" own "${commands}")
if(NOT own OR own MATCHES "-ffp-contract|-Wconversion|-fno-math-errno|-Werror")
    message(FATAL_ERROR "a consumer's compile line has flags of ours: ${own}")
endif()
if(NOT WAY STREQUAL "find_package")
    string(REGEX MATCHALL "\"output\": " objects "${commands}")
    list(LENGTH objects count)
    math(EXPR count "${count} + 8")  # with all instruction sets there are four more kernels of each of two layers
    if(count GREATER 70)
        message(FATAL_ERROR "${count} objects, expected at most 70")
    endif()
endif()
if(WAY STREQUAL "FetchContent")
    # The same objects as with add_subdirectory, which builds and links them all: the headers, and one library, suffice here.
    run(${CMAKE_COMMAND} --build ${WORK}/build --target CMakeFiles/consumer.dir/consumer.cpp.o halflit_sh)
    return()
endif()
run(${CMAKE_COMMAND} --build ${WORK}/build)
file(GLOB programs ${WORK}/build/consumer ${WORK}/build/consumer_of_files)
foreach(program IN LISTS programs)
    run(${program})
    message(STATUS "${output}")
endforeach()
