# Sources that read models and need no library but fmt. The page (apps/web) compiles them too.
set(HALFLIT_COMPRESSION_SOURCES detail/draco_mesh.cpp detail/gltf_draco.cpp detail/gltf_meshopt.cpp detail/meshopt_filter.cpp
    detail/meshopt_vertices.cpp)
# Groups of sources that are compiled together, for halflit_unity.
set(HALFLIT_MODEL_SOURCES
    GROUP detail/gltf_animation.cpp detail/gltf_property.cpp detail/gltf_track.cpp detail/gltf_motion.cpp detail/gltf_deform.cpp
    GROUP detail/gltf_file.cpp detail/gltf_notes.cpp detail/gltf_used.cpp detail/gltf_json.cpp detail/gltf_schema.cpp
          detail/gltf_schema_rows.cpp
          detail/gltf_node_transform.cpp detail/gltf_choices.cpp detail/gltf_versions.cpp detail/glb_container.cpp
          detail/gltf_document.cpp
    GROUP detail/gltf_accessor.cpp detail/gltf_vertex_values.cpp detail/gltf_images.cpp detail/gltf_materials.cpp
          detail/gltf_glossiness.cpp
          detail/gltf_primitive.cpp detail/gltf_meshes.cpp
          detail/gltf_instancing.cpp detail/gltf_skin.cpp detail/gltf_nodes.cpp detail/gltf_placed.cpp detail/gltf_world.cpp
          gltf_loader.cpp pose.cpp
    GROUP detail/model_format.cpp detail/model_builder.cpp detail/soup.cpp detail/crease_normals.cpp
          detail/polygon.cpp detail/stl_reader.cpp detail/ply_header.cpp model_loader.cpp
    GROUP detail/ply_reader.cpp detail/mtl.cpp detail/mtl_pictures.cpp detail/obj_reader.cpp detail/obj_strokes.cpp)
