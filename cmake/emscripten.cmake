# Toolchain for browsers: Debian's Emscripten. `dev web` uses it.
#   apt-get install emscripten
# Its cache is used as it is installed, so there are no ports: libraries are header-only, or the browser's.
set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten CACHE PATH "Folder of Emscripten")
set(EMSCRIPTEN_SYSTEM_PROCESSOR wasm32)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
# Node.js from 18 on has fetch, by which these programs would ask a server for their code instead of reading it.
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch)
set(CMAKE_CXX_LINKER_LAUNCHER env NODE_PATH=/usr/share/nodejs)  # Debian's acorn, for a Node.js that is not Debian's

# Header-only libraries of the build machine, without the other headers of its /usr/include.
set(HALFLIT_HEADER_LINKS ${CMAKE_BINARY_DIR}/header-only)
foreach(folder xsimd tl fmt stb catch2)
    if(EXISTS /usr/include/${folder} AND NOT EXISTS ${HALFLIT_HEADER_LINKS}/${folder})
        file(MAKE_DIRECTORY ${HALFLIT_HEADER_LINKS})
        file(CREATE_LINK /usr/include/${folder} ${HALFLIT_HEADER_LINKS}/${folder} SYMBOLIC)
    endif()
endforeach()
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${HALFLIT_HEADER_LINKS})
set(CMAKE_EXE_LINKER_FLAGS_INIT "-sALLOW_MEMORY_GROWTH=1")
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/emscripten)  # packages that are headers alone
