# Decoders of models and pictures, compiled from Debian's sources that apps/web/sources.sh has unpacked in HALFLIT_WEB_LIBRARIES: only what
# reads. Their SIMD versions stay out: they give the same bits.
#   halflit_web_libraries  all of them, with their folders of headers; without the sources, there is no such target
set(HALFLIT_WEB_LIBRARIES "" CACHE PATH "Folder of the libraries' sources; empty: neither the page nor the npm package is made")
if(NOT HALFLIT_WEB_LIBRARIES)
    return()
endif()
add_library(halflit_web_libraries INTERFACE)
set(made ${CMAKE_CURRENT_BINARY_DIR}/libraries)

# Folder of a package's source; its name has the version. The version's first three numbers go to `version`.
function(halflit_web_source package folder version)
    file(GLOB found ${HALFLIT_WEB_LIBRARIES}/${package}-[0-9]*)
    list(LENGTH found count)
    if(NOT count EQUAL 1)
        message(FATAL_ERROR "halflit: expected one folder ${package}-VERSION in ${HALFLIT_WEB_LIBRARIES}, found ${count}")
    endif()
    string(REGEX MATCH "-([0-9.]+)[^/]*$" unused ${found})
    set(${folder} ${found} PARENT_SCOPE)
    set(${version} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

# halflit_web_library(name FOLDERS.. SOURCES.. [DEFINES..]): warnings of others' code are not shown.
function(halflit_web_library name)
    cmake_parse_arguments(arg "" "" "FOLDERS;SOURCES;DEFINES" ${ARGN})
    add_library(halflit_web_${name} STATIC ${arg_SOURCES})
    target_include_directories(halflit_web_${name} SYSTEM PUBLIC ${arg_FOLDERS})
    target_compile_definitions(halflit_web_${name} PRIVATE ${arg_DEFINES})
    target_compile_options(halflit_web_${name} PRIVATE -w $<$<CONFIG:Release>:-O2>)
    target_link_libraries(halflit_web_libraries INTERFACE halflit_web_${name})
endfunction()

halflit_web_source(libjpeg-turbo jpeg VERSION)
set(JPEG_LIB_VERSION 62)  # as in Debian's library
set(LIBJPEG_TURBO_VERSION_NUMBER 2000000)  # no one asks
set(D_ARITH_CODING_SUPPORTED 1)
set(MEM_SRCDST_SUPPORTED 1)
set(BITS_IN_JSAMPLE 8)
set(INLINE "inline")
set(SIZE_T 4)
foreach(name jconfig jconfigint jversion)
    configure_file(${jpeg}/${name}.h.in ${made}/jpeg/${name}.h)
endforeach()
set(sources "")
foreach(name jcomapi jdapimin jdapistd jdatasrc jdcoefct jdcolor jddctmgr jdhuff jdicc jdinput jdmainct jdmarker jdmaster jdmerge jdphuff
        jdpostct jdsample jdarith jaricom jerror jidctflt jidctfst jidctint jidctred jquant1 jquant2 jutils jmemmgr jmemnobs jsimd_none)
    list(APPEND sources ${jpeg}/${name}.c)
endforeach()
halflit_web_library(jpeg FOLDERS ${made}/jpeg ${jpeg} SOURCES ${sources})

halflit_web_source(libdeflate deflate unused)
set(sources "")
foreach(name utils crc32 adler32 deflate_decompress deflate_compress zlib_compress zlib_decompress)
    list(APPEND sources ${deflate}/lib/${name}.c)
endforeach()
halflit_web_library(deflate FOLDERS ${deflate} SOURCES ${sources})

# A parser's hash is salted with a random number, which random_bytes.cpp gets from the host.
halflit_web_source(expat expat unused)
file(CONFIGURE OUTPUT ${made}/expat/expat_config.h @ONLY CONTENT
"#define XML_NS 1
#define XML_DTD 1
#define XML_CONTEXT_BYTES 1024
#define HAVE_ARC4RANDOM_BUF 1
void arc4random_buf(void*, __SIZE_TYPE__);
")
set(sources "")
foreach(name xmlparse xmlrole xmltok)
    list(APPEND sources ${expat}/expat/lib/${name}.c)
endforeach()
halflit_web_library(expat FOLDERS ${made}/expat ${expat}/expat/lib SOURCES ${sources})

halflit_web_source(draco draco unused)
include(${PROJECT_SOURCE_DIR}/cmake/draco.cmake)
halflit_draco_decoder(${draco} ${made}/draco sources)
halflit_web_library(draco FOLDERS ${made}/draco ${draco}/src SOURCES ${sources})

halflit_web_source(meshoptimizer meshopt unused)
halflit_web_library(meshopt FOLDERS ${meshopt}/src SOURCES ${meshopt}/src/vertexcodec.cpp ${meshopt}/src/indexcodec.cpp)

halflit_web_source(libwebp webp unused)
file(GLOB sources ${webp}/src/dec/*.c)
foreach(name alpha_processing cpu dec dec_clip_tables filters lossless rescaler upsampling yuv)
    list(APPEND sources ${webp}/src/dsp/${name}.c)
endforeach()
foreach(name bit_reader color_cache filters huffman quant_levels_dec random rescaler thread utils)
    set(file ${webp}/src/utils/${name}_utils.c)
    if(name STREQUAL utils)
        set(file ${webp}/src/utils/utils.c)
    endif()
    list(APPEND sources ${file})
endforeach()
halflit_web_library(webp FOLDERS ${webp} ${webp}/src SOURCES ${sources})
