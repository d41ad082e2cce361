"""Structs, constants and functions of halflit.h. Made by declarations.py."""
# fmt: off
STRUCTS = {
    "halflit_load_options": """
        size_t size; const char* scene; const char* variant; const char* animation; double time_s; int32_t keep_animations;
        int32_t up; int32_t recentre; float crease_deg; int32_t strict; int32_t threads; const char* const* allow_external; size_t
        allow_external_count; double time_limit_s; uint64_t max_file_bytes; uint64_t max_total_bytes; uint64_t max_json_tokens;
        uint64_t max_texture_bytes; uint64_t max_texture_pixels; uint64_t max_geometry_bytes; uint64_t max_lights; int32_t
        max_json_depth; int32_t max_texture_side; int32_t max_jpeg_scans; int32_t plate; uint64_t max_work; double detail_px;
        const char* const* importers; size_t importers_count;
""",
    "halflit_counts": """
        size_t size; uint64_t triangles; int32_t meshes, instances, materials, textures, cameras; int32_t lights; int32_t nodes;
        int32_t animations; int32_t warnings; int32_t reserved;
""",
    "halflit_animation": """
        size_t size; const char* name; double end_s; uint64_t channels;
""",
    "halflit_node": """
        size_t size; const char* name; const int32_t* instances; int32_t instance_count; int32_t parent; int32_t camera, light;
""",
    "halflit_texture_use": """
        int32_t texture; int32_t uv_set; int32_t wrap_u, wrap_v; int32_t mag_filter, min_filter; int32_t mip_filter; float
        row_u[3], row_v[3];
""",
    "halflit_lobe": """
        float wrap; float power; int32_t normalize;
""",
    "halflit_material": """
        size_t size; const char* name; int32_t alpha_mode; int32_t double_sided; int32_t unlit; int32_t own_lobe; int32_t
        shadow_catcher; halflit_lobe lobe; float base_color[4]; float metallic; float roughness; float dielectric_reflectance;
        float emissive[3]; float normal_scale; float occlusion_strength; float alpha_cutoff; float specular; float
        specular_color[3]; float transmission; float thickness; float attenuation_distance; float attenuation_color[3]; float
        clearcoat; float clearcoat_roughness; float clearcoat_normal_scale; float sheen_color[3]; float sheen_roughness; float
        iridescence; float iridescence_ior; float iridescence_thickness_min_nm; float iridescence_thickness_max_nm; float
        anisotropy_strength; float anisotropy_rotation_rad; halflit_texture_use base_color_texture; halflit_texture_use
        metallic_roughness_texture; halflit_texture_use normal_texture; halflit_texture_use occlusion_texture; halflit_texture_use
        emissive_texture; halflit_texture_use specular_texture; halflit_texture_use specular_color_texture; halflit_texture_use
        transmission_texture; halflit_texture_use thickness_texture; halflit_texture_use clearcoat_texture; halflit_texture_use
        clearcoat_roughness_texture; halflit_texture_use clearcoat_normal_texture; halflit_texture_use sheen_color_texture;
        halflit_texture_use sheen_roughness_texture; halflit_texture_use iridescence_texture; halflit_texture_use
        iridescence_thickness_texture; halflit_texture_use anisotropy_texture; float dispersion; float diffuse_transmission; float
        diffuse_transmission_color[3]; halflit_texture_use diffuse_transmission_texture; halflit_texture_use
        diffuse_transmission_color_texture; int32_t reserved[2];
""",
    "halflit_splats": """
        size_t size; const float* rotations; const float* scales; const float* opacities; const float* harmonics; int32_t degree;
        int32_t reference; int32_t linear_light; int32_t reserved;
""",
    "halflit_mesh": """
        size_t size; const char* name; const float* positions; const float* normals; const float* tangents; const float* uv0;
        const float* uv1; const float* colors; const uint32_t* indices; size_t vertex_count; size_t index_count; int32_t material;
        int32_t topology; int32_t smooth; int32_t reserved; const halflit_splats* splats;
""",
    "halflit_instance": """
        size_t size; int32_t mesh; int32_t material; int32_t visible; int32_t node; float color[4]; float world_from_object[16];
        double place_rest[3];
""",
    "halflit_camera": """
        size_t size; const char* name; float world_from_camera[16]; int32_t orthographic; float fov_y_rad; float aspect; float
        half_height, half_width; float near_z; float far_z; float sides[4]; int32_t reserved; double place_rest[3];
""",
    "halflit_view": """
        size_t size; double margin_x, margin_y; float azimuth_deg; float elevation_deg; float zoom; float fov_y_deg; int32_t
        orthographic; int32_t any_side;
""",
    "halflit_light": """
        size_t size; int32_t type; float color[3]; float position[3]; float direction[3]; float range; float source_radius; float
        inner_cone_rad, outer_cone_rad; float cone_power; float shadow_radius; double position_rest[3];
""",
    "halflit_environment_options": """
        size_t size; double rotate_rad; int32_t extract_suns; int32_t keep_image; int32_t calibrated; int32_t reserved;
""",
    "halflit_region": """
        int32_t x, y; int32_t width, height;
""",
    "halflit_settings": """
        size_t size; double max_error_codes; double environment_tolerance; uint64_t shadow_memory_limit; halflit_region region;
        float background[4]; int32_t background_environment; int32_t override_lobe; halflit_lobe lobe; int32_t samples; float
        exposure; int32_t tone_curve; float point_size; float line_width; int32_t accuracy; int32_t texture_detail; int32_t
        anisotropy; int32_t specular; int32_t normalize_specular; float normal_scale; int32_t shading_rate; int32_t
        environment_bands; int32_t shadows; int32_t shadow_size; int32_t soft_shadow_maps; float shadow_fade; int32_t sky_shadows;
        int32_t shadow_terminator_offset; float emission_scale; int32_t edges; int32_t hidden_edges; float edge_angle_deg; float
        edge_width; float edge_color[3]; int32_t max_layers; float contact_shadow; int32_t alpha; float shadow_softness_deg;
        int32_t edl; float edl_strength; int32_t edge_contrast; int32_t reserved[1];
""",
    "halflit_picture_request": """
        size_t size; const halflit_camera* camera; const char* scene_camera; double studio_turn_rad; int32_t width, height;
        int32_t frame; float azimuth_deg; float elevation_deg; float zoom; float fov_y_deg; int32_t orthographic; int32_t
        own_ambient; float ambient_color[3]; float exposure; int32_t add_lights; int32_t studio; int32_t any_side; double
        margin_x, margin_y; double exposure_compensation_ev;
""",
    "halflit_execution": """
        size_t size; const char* isa; void* user; int32_t (*cancelled)(void* user); void (*on_tile)(void* user, int32_t x, int32_t
        y, int32_t width, int32_t height); void (*progress)(void* user, double share); void (*parallel_for)(void* user, int32_t
        count, void (*body)(void* task, int32_t i), void* task); int32_t threads; int32_t tile_size; double time_limit_s; size_t
        memory_limit; int32_t stop_at_interrupt; int32_t reserved;
""",
    "halflit_target": """
        size_t size; int32_t width, height; int32_t format; int32_t region_alone; void* pixels; size_t row_bytes; float* depth;
        size_t depth_row_bytes; float* normal; size_t normal_row_bytes; float* shading_normal; size_t shading_normal_row_bytes;
        float* albedo; size_t albedo_row_bytes; float* position; size_t position_row_bytes; uint32_t* instance; size_t
        instance_row_bytes; uint32_t* triangle; size_t triangle_row_bytes; uint32_t* lights; size_t lights_row_bytes; float*
        coverage; size_t coverage_row_bytes; float* barycentric; size_t barycentric_row_bytes; float* uv; size_t uv_row_bytes;
""",
    "halflit_report": """
        size_t size; double total_ms; double prepare_ms; double plan_ms; double shadows_ms; double cull_ms, transform_ms, bin_ms;
        double tiles_ms; double error_budget; double error_codes; uint64_t triangles_submitted; uint64_t triangles_drawn; uint64_t
        triangles_not_finite; uint64_t pixels_visible; uint64_t fragments_shaded; uint64_t nan_pixels; char isa[16]; int32_t
        error_within; int32_t threads; int32_t warnings; int32_t reserved;
""",
    "halflit_measured": """
        size_t size; double codes, asked_percent; double percent; int32_t probes, outside; int32_t samples, anisotropy,
        shadow_size; int32_t reserved;
""",
    "halflit_mujoco_layout": """
        size_t size; int32_t geom_size; int32_t geom_type, geom_dataid, geom_objtype, geom_objid, geom_texid, geom_texuniform,
        geom_matid, geom_texcoord, geom_segid; int32_t geom_texrepeat, geom_scale, geom_pos, geom_mat, geom_rgba; int32_t
        geom_emission, geom_specular, geom_shininess, geom_reflectance, geom_modelrbound; int32_t light_size; int32_t light_pos,
        light_dir, light_attenuation, light_cutoff, light_exponent; int32_t light_ambient, light_diffuse, light_specular; int32_t
        light_headlight, light_directional, light_castshadow; int32_t light_type; int32_t camera_size; int32_t camera_pos,
        camera_forward, camera_up, camera_center, camera_width; int32_t camera_bottom, camera_top, camera_near, camera_far;
        int32_t camera_orthographic; int32_t type_skin, type_flex, type_linebox, type_triangle;
""",
    "halflit_mujoco_model": """
        size_t size; const halflit_mujoco_layout* layout; double extent; float znear, zfar, shadowclip, shadowscale, fogstart,
        fogend, haze; float fog_rgba[4], haze_rgba[4]; float linewidth; int32_t shadowsize, numslices, numstacks, numquads;
        int32_t ngeom, nmat, nmesh, nmeshvert, nmeshnormal, nmeshtexcoord, nmeshface, nmeshgraph, nhfield, nhfielddata, ntex;
        int32_t nskin, nskinvert, nskintexvert, nskinface, nflex; uint64_t ntexdata; const int32_t* geom_type; const int32_t*
        geom_matid; const double* geom_size; const int32_t* mat_texid; const uint8_t* mat_texuniform; const float* mat_texrepeat;
        const int32_t* mesh_vertadr; const int32_t* mesh_vertnum; const int32_t* mesh_normaladr; const int32_t* mesh_texcoordadr;
        const int32_t* mesh_faceadr; const int32_t* mesh_facenum; const int32_t* mesh_graphadr; const float* mesh_vert; const
        float* mesh_normal; const float* mesh_texcoord; const int32_t* mesh_face; const int32_t* mesh_facenormal; const int32_t*
        mesh_facetexcoord; const int32_t* mesh_graph; const double* hfield_size; const int32_t* hfield_nrow; const int32_t*
        hfield_ncol; const int32_t* hfield_adr; const float* hfield_data; const int32_t* tex_type; const int32_t* tex_width; const
        int32_t* tex_height; const int32_t* tex_nchannel; const int32_t* tex_colorspace; const int64_t* tex_adr; const uint8_t*
        tex_data; const int32_t* skin_vertadr; const int32_t* skin_vertnum; const int32_t* skin_texcoordadr; const int32_t*
        skin_faceadr; const int32_t* skin_facenum; const float* skin_texcoord; const int32_t* skin_face; const int32_t*
        flex_facenum;
""",
    "halflit_mujoco_scene": """
        size_t size; const void* geoms; const void* lights; const void* camera; const uint8_t* flags; const float* skinvert; const
        float* skinnormal; const int32_t* flexfaceused; const float* flexface; const float* flexnormal; int32_t ngeom, nlight;
        int32_t enabletransform; float translate[3], rotate[4], scale; int32_t reserved;
""",
    "halflit_mujoco_picture": """
        size_t size; const halflit_mujoco_scene* scene; const void* camera; const uint8_t* flags; uint8_t* rgb; float* depth;
        int32_t* segid; int32_t* object; int32_t width, height; int32_t samples; int32_t bottom_up; int32_t depth_unit; int32_t
        depth_pass;
""",
}
CONSTANTS = {
    "HALFLIT_OK": 0,
    "HALFLIT_ERROR_USAGE": 2,
    "HALFLIT_ERROR_BAD_INPUT": 3,
    "HALFLIT_ERROR_IO": 4,
    "HALFLIT_ERROR_LIMIT": 5,
    "HALFLIT_ERROR_INTERNAL": 6,
    "HALFLIT_ERROR_CANCELLED": 7,
    "HALFLIT_UP_BY_FORMAT": 0,
    "HALFLIT_UP_X": 1,
    "HALFLIT_UP_Y": 2,
    "HALFLIT_UP_Z": 3,
    "HALFLIT_UP_MINUS_X": 4,
    "HALFLIT_UP_MINUS_Y": 5,
    "HALFLIT_UP_MINUS_Z": 6,
    "HALFLIT_PART_NODE": 0,
    "HALFLIT_PART_INSTANCE": 1,
    "HALFLIT_PART_MESH": 2,
    "HALFLIT_PART_MATERIAL": 3,
    "HALFLIT_PART_CAMERA": 4,
    "HALFLIT_COLOR_SRGB": 0,
    "HALFLIT_COLOR_LINEAR": 1,
    "HALFLIT_COLOR_SRGB_BY_ALPHA": 2,
    "HALFLIT_COLOR_NORMAL": 3,
    "HALFLIT_ALPHA_OPAQUE": 0,
    "HALFLIT_ALPHA_MASK": 1,
    "HALFLIT_ALPHA_BLEND": 2,
    "HALFLIT_WRAP_REPEAT": 0,
    "HALFLIT_WRAP_MIRROR": 1,
    "HALFLIT_WRAP_CLAMP": 2,
    "HALFLIT_FILTER_NEAREST": 0,
    "HALFLIT_FILTER_LINEAR": 1,
    "HALFLIT_MIP_NONE": 0,
    "HALFLIT_MIP_NEAREST": 1,
    "HALFLIT_MIP_LINEAR": 2,
    "HALFLIT_TOPOLOGY_TRIANGLES": 0,
    "HALFLIT_TOPOLOGY_LINES": 1,
    "HALFLIT_TOPOLOGY_POINTS": 2,
    "HALFLIT_SPLATS_INRIA": 0,
    "HALFLIT_SPLATS_INRIA_AA": 1,
    "HALFLIT_SPLATS_KHR": 2,
    "HALFLIT_SPLATS_MIP": 3,
    "HALFLIT_LIGHT_DIRECTIONAL": 0,
    "HALFLIT_LIGHT_POINT": 1,
    "HALFLIT_LIGHT_SPOT": 2,
    "HALFLIT_ACCURACY_REFERENCE": 0,
    "HALFLIT_ACCURACY_EXACT": 1,
    "HALFLIT_RATE_FLAT": 0,
    "HALFLIT_RATE_GOURAUD": 1,
    "HALFLIT_RATE_PIXEL": 2,
    "HALFLIT_DETAIL_FULL": 0,
    "HALFLIT_DETAIL_BILINEAR": 1,
    "HALFLIT_DETAIL_NEAREST": 2,
    "HALFLIT_SPECULAR_NONE": 0,
    "HALFLIT_SPECULAR_PHONG": 1,
    "HALFLIT_SPECULAR_BLINN": 2,
    "HALFLIT_SPECULAR_GGX": 3,
    "HALFLIT_SHADOWS_OFF": 0,
    "HALFLIT_SHADOWS_HARD": 1,
    "HALFLIT_SHADOWS_SOFT_SPLIT": 2,
    "HALFLIT_TONE_NONE": 0,
    "HALFLIT_TONE_REINHARD": 1,
    "HALFLIT_TONE_ACES": 2,
    "HALFLIT_TONE_NEUTRAL": 3,
    "HALFLIT_EDGES_NONE": 0,
    "HALFLIT_EDGES_FEATURE": 1,
    "HALFLIT_EDGES_SILHOUETTE": 2,
    "HALFLIT_EDGES_ALL": 3,
    "HALFLIT_ALPHA_SPACE_LINEAR": 0,
    "HALFLIT_ALPHA_SPACE_DISPLAY": 1,
    "HALFLIT_HIDDEN_EDGES_NONE": 0,
    "HALFLIT_HIDDEN_EDGES_DASHED": 1,
    "HALFLIT_EDL_OFF": 0,
    "HALFLIT_EDL_AUTO": 1,
    "HALFLIT_EDL_ON": 2,
    "HALFLIT_STUDIO_FOR_DARK": 0,
    "HALFLIT_STUDIO_ALWAYS": 1,
    "HALFLIT_STUDIO_NEVER": 2,
    "HALFLIT_STUDIO_UNDER_LIGHTS": 3,
    "HALFLIT_FORMAT_RGBA8": 0,
    "HALFLIT_FORMAT_BGRA8": 1,
    "HALFLIT_FORMAT_RGBA8_PREMULTIPLIED": 2,
    "HALFLIT_FORMAT_BGRA8_PREMULTIPLIED": 3,
    "HALFLIT_FORMAT_RGBA_F32": 4,
    "HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED": 5,
    "HALFLIT_MUJOCO_DEPTH_WINDOW": 0,
    "HALFLIT_MUJOCO_DEPTH_DISTANCE": 1,
    "HALFLIT_MUJOCO_PASS_SEGMENT": 0,
    "HALFLIT_MUJOCO_PASS_COLOR": 1,
}
FUNCTIONS = """
const char* halflit_version(void);
int32_t halflit_pixel_epoch(void);
const char* halflit_last_error(void);
void halflit_stop_at_interrupt(int32_t stops);
int32_t halflit_load_options_init(halflit_load_options* options, size_t size);
int32_t halflit_scene_create(halflit_scene** scene);
int32_t halflit_scene_load(const char* path, const halflit_load_options* options, halflit_scene** scene);
int32_t halflit_scene_load_memory(const void* bytes, size_t count, const char* name, const char* base_dir, const halflit_load_options* options, halflit_scene** scene);
int32_t halflit_scene_add_file(halflit_scene* scene, const char* path, const halflit_load_options* options, const double* world_from_file, int32_t* first, int32_t* count);
int32_t halflit_scene_add_file_memory(halflit_scene* scene, const void* bytes, size_t byte_count, const char* name, const char* base_dir, const halflit_load_options* options, const double* world_from_file, int32_t* first, int32_t* count);
int32_t halflit_scene_create_demo(halflit_scene** scene);
int32_t halflit_scene_set_up(halflit_scene* scene, int32_t up);
int32_t halflit_scene_save(const halflit_scene* scene, halflit_write write, void* user);
int32_t halflit_scene_restore(halflit_scene* scene, const void* bytes, size_t count);
void halflit_scene_destroy(halflit_scene* scene);
int32_t halflit_scene_get_counts(const halflit_scene* scene, halflit_counts* counts);
int32_t halflit_scene_get_warning(const halflit_scene* scene, int32_t index, const char** text);
int32_t halflit_scene_get_animation(const halflit_scene* scene, int32_t index, halflit_animation* animation);
int32_t halflit_scene_pose(halflit_scene* scene, const char* animation, double time_s);
int32_t halflit_scene_get_placement(const halflit_scene* scene, double origin[3], double* scale, int32_t* up);
int32_t halflit_scene_get_name(const halflit_scene* scene, int32_t part, int32_t index, const char** name);
int32_t halflit_scene_set_name(halflit_scene* scene, int32_t part, int32_t index, const char* name);
int32_t halflit_scene_get_node(const halflit_scene* scene, int32_t index, halflit_node* node);
int32_t halflit_scene_get_bounds(const halflit_scene* scene, float min[3], float max[3]);
int32_t halflit_scene_get_box(const halflit_scene* scene, double min[3], double max[3]);
int32_t halflit_scene_add_texture(halflit_scene* scene, const uint8_t* rgba8, int32_t width, int32_t height, size_t row_bytes, int32_t color, int32_t* index);
int32_t halflit_scene_set_texture(halflit_scene* scene, int32_t index, const uint8_t* rgba8, int32_t width, int32_t height, size_t row_bytes, int32_t color);
int32_t halflit_scene_remove_texture(halflit_scene* scene, int32_t index);
int32_t halflit_lobe_by_name(const char* name, float wrap, halflit_lobe* lobe);
int32_t halflit_material_init(halflit_material* material, size_t size);
int32_t halflit_scene_add_material(halflit_scene* scene, const halflit_material* material, int32_t* index);
int32_t halflit_scene_get_material(const halflit_scene* scene, int32_t index, halflit_material* material);
int32_t halflit_scene_set_material(halflit_scene* scene, int32_t index, const halflit_material* material);
int32_t halflit_splats_init(halflit_splats* splats, size_t size);
int32_t halflit_mesh_init(halflit_mesh* mesh, size_t size);
int32_t halflit_scene_add_mesh(halflit_scene* scene, const halflit_mesh* mesh, int32_t* index);
int32_t halflit_scene_set_mesh(halflit_scene* scene, int32_t index, const halflit_mesh* mesh);
int32_t halflit_scene_set_vertices(halflit_scene* scene, int32_t index, const float* positions, const float* normals, size_t vertex_count);
int32_t halflit_scene_remove_mesh(halflit_scene* scene, int32_t index);
int32_t halflit_instance_init(halflit_instance* instance, size_t size);
int32_t halflit_scene_add_instance(halflit_scene* scene, int32_t mesh, const float world_from_object[16], int32_t* index);
int32_t halflit_scene_add_instances(halflit_scene* scene, int32_t mesh, int32_t count, const float* world_from_object, int32_t* first);
int32_t halflit_scene_add_instances_double(halflit_scene* scene, int32_t mesh, int32_t count, const double* world_from_object, int32_t* first);
int32_t halflit_scene_get_instance(const halflit_scene* scene, int32_t index, halflit_instance* instance);
int32_t halflit_scene_set_instance(halflit_scene* scene, int32_t index, const halflit_instance* instance);
int32_t halflit_scene_place_instance(halflit_scene* scene, int32_t index, const float world_from_object[16]);
int32_t halflit_scene_place_instances(halflit_scene* scene, const int32_t* indices, int32_t count, const float* world_from_object);
int32_t halflit_scene_place_instances_double(halflit_scene* scene, const int32_t* indices, int32_t count, const double* world_from_object);
int32_t halflit_scene_remove_instance(halflit_scene* scene, int32_t index);
int32_t halflit_scene_add_ground(halflit_scene* scene, int32_t* instance);
int32_t halflit_camera_init(halflit_camera* camera, size_t size);
int32_t halflit_camera_look_at(const float eye[3], const float target[3], const float up[3], halflit_camera* camera);
int32_t halflit_camera_from_intrinsics(const double k[9], int32_t width, int32_t height, const double rotation[9], const double translation[3], double first_pixel, halflit_camera* camera);
int32_t halflit_camera_frame(const halflit_scene* scene, float aspect, float azimuth_deg, float elevation_deg, float zoom, halflit_camera* camera);
int32_t halflit_view_init(halflit_view* view, size_t size);
int32_t halflit_view_by_name(const halflit_scene* scene, const char* name, halflit_view* view);
int32_t halflit_camera_view(const halflit_scene* scene, float aspect, const halflit_view* view, halflit_camera* camera);
int32_t halflit_camera_views(const halflit_scene* scene, float aspect, const halflit_view* views, int32_t count, halflit_camera* cameras);
int32_t halflit_camera_orbit(const double target[3], double azimuth_deg, double elevation_deg, double distance, int32_t up, halflit_camera* camera);
int32_t halflit_scene_get_camera(const halflit_scene* scene, int32_t index, halflit_camera* camera);
int32_t halflit_light_init(halflit_light* light, size_t size);
int32_t halflit_scene_add_light(halflit_scene* scene, const halflit_light* light, int32_t* index);
int32_t halflit_scene_get_light(const halflit_scene* scene, int32_t index, halflit_light* light);
int32_t halflit_scene_set_light(halflit_scene* scene, int32_t index, const halflit_light* light);
int32_t halflit_scene_remove_light(halflit_scene* scene, int32_t index);
int32_t halflit_scene_set_ambient(halflit_scene* scene, const float sky[3], const float ground[3]);
int32_t halflit_scene_add_default_lights(halflit_scene* scene, const halflit_camera* camera);
int32_t halflit_scene_add_studio(halflit_scene* scene, const halflit_camera* camera);
int32_t halflit_scene_clear_lights(halflit_scene* scene);
int32_t halflit_environment_options_init(halflit_environment_options* options, size_t size);
int32_t halflit_scene_set_environment(halflit_scene* scene, const float* rgb, int32_t width, int32_t height, const halflit_environment_options* options);
int32_t halflit_scene_load_environment(halflit_scene* scene, const char* path, const halflit_environment_options* options);
int32_t halflit_scene_set_sky(halflit_scene* scene, const halflit_environment_options* options);
int32_t halflit_settings_init(halflit_settings* settings, size_t size);
int32_t halflit_settings_read(halflit_settings* settings, const char* name, const char* value);
int32_t halflit_picture_request_init(halflit_picture_request* request, size_t size);
int32_t halflit_choose_picture(const halflit_scene* scene, const halflit_picture_request* request, int32_t size[2], halflit_camera* camera, halflit_settings* settings, halflit_lighting** lighting);
void halflit_lighting_destroy(halflit_lighting* lighting);
int32_t halflit_execution_init(halflit_execution* execution, size_t size);
int32_t halflit_renderer_create(const halflit_execution* execution, halflit_renderer** renderer);
int32_t halflit_renderer_set_execution(halflit_renderer* renderer, const halflit_execution* execution);
void halflit_renderer_destroy(halflit_renderer* renderer);
int32_t halflit_target_init(halflit_target* target, size_t size);
int32_t halflit_render(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting, const halflit_camera* camera, const halflit_settings* settings, const halflit_target* target, halflit_report* report);
int32_t halflit_renderer_get_warning(const halflit_renderer* renderer, int32_t index, const char** text);
int32_t halflit_ray_distances(const halflit_camera* camera, int32_t width, int32_t height, const halflit_region* region, float* depth);
int32_t halflit_depth_codes(const float* depth, size_t count, uint16_t* codes, double range[2]);
int32_t halflit_view_normals(const halflit_camera* camera, float* normal, size_t count);
int32_t halflit_scene_mesh_numbers(const halflit_scene* scene, uint32_t* instance, size_t count);
int32_t halflit_scene_material_numbers(const halflit_scene* scene, uint32_t* instance, size_t count);
int32_t halflit_motion(const halflit_scene* scene, const halflit_camera* camera, const halflit_scene* other, const halflit_camera* other_camera, int32_t width, int32_t height, const uint32_t* instance, const uint32_t* triangle, const float* barycentric, size_t count, float* motion);
int32_t halflit_measured_init(halflit_measured* measured, size_t size);
int32_t halflit_measure(halflit_renderer* renderer, const halflit_scene* scene, const halflit_lighting* lighting, const halflit_camera* camera, const halflit_settings* settings, int32_t width, int32_t height, halflit_measured* measured);
uint64_t halflit_pixel_hash(const void* bytes, size_t count);
int32_t halflit_write_image(const char* path, const halflit_target* target);
int32_t halflit_encode_image(const char* format, const halflit_target* target, halflit_write write, void* user);
int32_t halflit_read_color(const char* text, float color[4]);
int32_t halflit_call(const char* name, const char* arguments, const halflit_scene* scene, halflit_answer** answer);
int32_t halflit_call_check(const char* name, const char* arguments);
const char* halflit_answer_report(const halflit_answer* answer);
const char* halflit_answer_notes(const halflit_answer* answer);
int32_t halflit_answer_is_good(const halflit_answer* answer);
const void* halflit_answer_picture(const halflit_answer* answer, int32_t* width, int32_t* height);
void halflit_answer_destroy(halflit_answer* answer);
int32_t halflit_mujoco_layout_init(halflit_mujoco_layout* layout, size_t size);
int32_t halflit_mujoco_model_init(halflit_mujoco_model* model, size_t size);
int32_t halflit_mujoco_scene_init(halflit_mujoco_scene* scene, size_t size);
int32_t halflit_mujoco_picture_init(halflit_mujoco_picture* picture, size_t size);
int32_t halflit_mujoco_create(const halflit_mujoco_model* model, const char* look, const halflit_execution* execution, halflit_mujoco** mujoco);
int32_t halflit_mujoco_render(halflit_mujoco* mujoco, const halflit_mujoco_picture* pictures, int32_t count);
void halflit_mujoco_destroy(halflit_mujoco* mujoco);
"""
