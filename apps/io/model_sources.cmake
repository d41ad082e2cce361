# Sources that read models and need no library but fmt and libdeflate. The page (apps/web) compiles them too.
set(HALFLIT_COMPRESSION_SOURCES codecs/codec_table.cpp codecs/draco_library.cpp codecs/exr_library.cpp codecs/linked_codecs.cpp
    gltf/codecs/draco.cpp gltf/codecs/meshopt.cpp gltf/codecs/meshopt_filter.cpp gltf/codecs/meshopt_vertices.cpp gltf/codecs/spz.cpp)
# Groups of sources that are compiled together, for halflit_unity.
set(HALFLIT_MODEL_SOURCES
    GROUP gltf/animation/animation.cpp gltf/animation/motion.cpp gltf/animation/track.cpp gltf/build/deform.cpp
          gltf/build/pose_sources.cpp gltf/file/property.cpp
    GROUP gltf/build/choices.cpp gltf/build/open.cpp gltf/file/document.cpp gltf/file/file.cpp gltf/file/json.cpp
          gltf/file/node_transform.cpp gltf/file/notes.cpp gltf/file/schema.cpp gltf/file/schema_rows.cpp gltf/file/used.cpp
          gltf/file/versions.cpp gltf/text/glb_container.cpp
    GROUP gltf/build/glossiness.cpp gltf/build/images.cpp gltf/build/instancing.cpp gltf/build/materials.cpp
          gltf/build/meshes.cpp gltf/build/nodes.cpp gltf/build/placed.cpp gltf/build/primitive.cpp gltf/build/skin.cpp
          gltf/codecs/splat_cloud.cpp gltf/build/vertex_values.cpp gltf/build/world.cpp gltf/file/accessor.cpp
          gltf/loader.cpp gltf/pose.cpp
    GROUP models/crease_normals.cpp models/model_builder.cpp models/model_colors.cpp models/formats.cpp
          models/gcode_picture.cpp models/model_loader.cpp models/ply_header.cpp
          models/polygon.cpp models/soup.cpp models/stl_reader.cpp models/text_scanner.cpp
    GROUP models/mtl.cpp models/mtl_pictures.cpp models/obj_reader.cpp models/obj_strokes.cpp models/off_reader.cpp
          models/ply_reader.cpp models/sog_reader.cpp models/splat_reader.cpp)
