# Draco's decoder of meshes, compiled from its source.
#   halflit_draco_decoder(SOURCE MADE OUT)
# OUT: the files to compile, with SOURCE/src and MADE as folders of headers. SOURCE: the folder of the source; MADE: for a header.
function(halflit_draco_decoder draco made out)
    file(CONFIGURE OUTPUT ${made}/draco/draco_features.h @ONLY CONTENT
"#define DRACO_MESH_COMPRESSION_SUPPORTED
#define DRACO_NORMAL_ENCODING_SUPPORTED
#define DRACO_STANDARD_EDGEBREAKER_SUPPORTED
#define DRACO_PREDICTIVE_EDGEBREAKER_SUPPORTED
#define DRACO_ATTRIBUTE_INDICES_DEDUPLICATION_SUPPORTED
#define DRACO_ATTRIBUTE_VALUES_DEDUPLICATION_SUPPORTED
#define DRACO_BACKWARDS_COMPATIBILITY_SUPPORTED
")
    set(list "")
    foreach(folder attributes core mesh point_cloud metadata compression)
        file(GLOB_RECURSE found ${draco}/src/draco/${folder}/*.cc)
        list(FILTER found EXCLUDE REGEX "/[^/]*(_test|test_|encod)[^/]*$|kd_tree")
        list(FILTER found EXCLUDE REGEX "mesh_(features|utils|splitter|stripifier|are_|misc|cleanup|conn)")
        list(FILTER found EXCLUDE REGEX "soup_mesh|point_cloud_builder|property_table|structural_meta")
        list(FILTER found EXCLUDE REGEX "compression/decode.cc|draco_compression")
        list(APPEND list ${found})
    endforeach()
    set(${out} "${list}" PARENT_SCOPE)
endfunction()
