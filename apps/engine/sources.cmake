# Sources of the engine. The page and the npm package (apps/web) compile them too, but for those of systems.
# Those that go through all pixels are compiled for speed.
set(HALFLIT_ENGINE_PIXELS pictures/canvas pictures/lettering pictures/marks pictures/sheet_page pictures/picture_diff compare/surface
    compare/hausdorff look/certificate look/triangle_tally trade/trade_error)
set(HALFLIT_ENGINE_WORDS basics/base64 basics/file_names basics/spelling basics/xml_text request/flags request/values
    request/setting_flags request/render_options job/part_choice job/picture_judgement job/section_cuts request/file_flags
    request/film_options request/camera_orbit request/camera_file request/camera_colmap request/given_camera request/kept_view
    request/classic_material request/request_check job/render_job job/job_choices job/light_choice job/view_choice
    job/scene_source job/built_in_scenes job/film_view job/import_detail job/parts job/part_finder job/part_look job/aov
    look/look_sheet look/part_views look/view_shot compare/model_pair compare/model_change compare/view_change
    pictures/html_page pictures/vector_file answers/pixel_story_text)
# All that writes or reads JSON: its header takes as long to compile as ten of these files.
set(HALFLIT_ENGINE_JSON request/camera_formats request/lobe_model job/aov_names answers/picture_compare answers/run_report
    answers/camera_json answers/measures_json answers/part_list answers/pixel_stories answers/pixel_story_json
    answers/scene_description look/look look/look_json compare/compare_files compare/report calls/call_arguments calls/call_text
    calls/calls)
# What needs a system: its folders and streams, and libraries that write films.
set(HALFLIT_ENGINE_FILMS film/gif_palette film/gif_writer film/apng_writer film/webp_writer)
set(HALFLIT_ENGINE_SYSTEM basics/output_folder job/standard_input film/film_writer)
set(HALFLIT_ENGINE_SERVER answers/answer_schema calls/answer_limits calls/kept_scenes)
# MuJoCo's scenes; compiled for speed too.
set(HALFLIT_ENGINE_MUJOCO mujoco/model mujoco/shapes mujoco/model_meshes mujoco/scene_reader mujoco/geom_parts mujoco/frame mujoco/drawer)
foreach(part PIXELS WORDS JSON FILMS SYSTEM SERVER MUJOCO)
    list(TRANSFORM HALFLIT_ENGINE_${part} APPEND .cpp)
endforeach()

# The font becomes a list of bytes that lettering.cpp includes.
set(font ${CMAKE_CURRENT_LIST_DIR}/fonts/dejavu_sans.ttf)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${font})
file(READ ${font} font_bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," font_bytes "${font_bytes}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/dejavu_sans.inc CONTENT "${font_bytes}\n" @ONLY)

# So do the tables of reports, which answer_schema.cpp includes.
file(GLOB tables CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/answers/*.txt)
set(rows "")
foreach(table IN LISTS tables)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${table})
    get_filename_component(kind ${table} NAME_WE)
    file(READ ${table} text)
    string(APPEND rows "{\"${kind}\", R\"~(${text})~\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/answer_tables.inc CONTENT "${rows}" @ONLY)
