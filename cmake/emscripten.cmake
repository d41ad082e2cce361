# Toolchain for browsers: Debian's Emscripten. `dev web` uses it.
#   apt-get install emscripten
# Its cache is used as it is installed, so there are no ports: libraries are header-only, or the browser's.
set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten CACHE PATH "Folder of Emscripten")
set(EMSCRIPTEN_SYSTEM_PROCESSOR wasm32)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
# Node.js from 18 on has fetch, by which these programs would ask a server for their code instead of reading it.
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch)
foreach(language C CXX)
    set(CMAKE_${language}_LINKER_LAUNCHER env NODE_PATH=/usr/share/nodejs)  # Debian's acorn, for a Node.js that is not Debian's
endforeach()

# Exceptions and longjmp by WebAssembly's own instructions: calls through JavaScript, which are the default, are larger and slower.
set(HALFLIT_EXCEPTION_FLAGS -fwasm-exceptions -sSUPPORT_LONGJMP=wasm)

include(${CMAKE_CURRENT_LIST_DIR}/header_only.cmake)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-sALLOW_MEMORY_GROWTH=1")
