# For toolchains whose compilers must not look into the build machine's /usr/include: a folder with links to the libraries there that are
# headers alone.
set(HALFLIT_HEADER_LINKS ${CMAKE_BINARY_DIR}/header-only)
foreach(folder xsimd tl fmt stb catch2 nlohmann CLI tiny_gltf.h)
    if(EXISTS /usr/include/${folder} AND NOT EXISTS ${HALFLIT_HEADER_LINKS}/${folder})
        file(MAKE_DIRECTORY ${HALFLIT_HEADER_LINKS})
        file(CREATE_LINK /usr/include/${folder} ${HALFLIT_HEADER_LINKS}/${folder} SYMBOLIC)
    endif()
endforeach()
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${HALFLIT_HEADER_LINKS})
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/header_only)  # packages that are headers alone
list(APPEND CMAKE_FIND_ROOT_PATH ${CMAKE_BINARY_DIR})  # a toolchain that looks below its roots alone finds the links too
