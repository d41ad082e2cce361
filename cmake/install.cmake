# Installation: libraries, headers, the program, and what find_package(halflit COMPONENTS raster io c) and pkg-config need.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/halflit)
get_property(components GLOBAL PROPERTY HALFLIT_COMPONENTS)

foreach(component IN LISTS components)
    get_property(targets GLOBAL PROPERTY HALFLIT_TARGETS_${component})
    install(TARGETS ${targets} EXPORT halflit_${component} COMPONENT development)
    install(EXPORT halflit_${component} NAMESPACE halflit:: FILE halflit_${component}_targets.cmake DESTINATION ${package_dir}
        COMPONENT development)
endforeach()
foreach(layer sh shading raster io c)
    get_property(headers GLOBAL PROPERTY HALFLIT_HEADERS_${layer})
    if(headers)
        install(DIRECTORY ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/halflit COMPONENT development FILES_MATCHING PATTERN "*.h*")
    endif()
endforeach()

get_property(io_libraries GLOBAL PROPERTY HALFLIT_IO_LIBRARIES)
get_property(engine_libraries GLOBAL PROPERTY HALFLIT_ENGINE_LIBRARIES)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/halflitConfig.cmake.in ${PROJECT_BINARY_DIR}/halflitConfig.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/halflitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/halflitConfig.cmake ${PROJECT_BINARY_DIR}/halflitConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake DESTINATION ${package_dir} COMPONENT development)

# Paths in .pc files start at the file itself, so that the installed tree may lie anywhere, unless a folder was given as an absolute path.
file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_prefix "\${pcfiledir}/${pc_prefix}")
set(pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
set(pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}" OR IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
    set(pc_prefix ${CMAKE_INSTALL_PREFIX})
    set(pc_libdir ${CMAKE_INSTALL_FULL_LIBDIR})
    set(pc_includedir ${CMAKE_INSTALL_FULL_INCLUDEDIR})
endif()

# halflit_pkg_config(FILE DESCRIPTION LIBRARIES REQUIRES): one .pc file.
function(halflit_pkg_config file description libraries requires)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/halflit.pc.in ${PROJECT_BINARY_DIR}/${file}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${file}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endfunction()
if(HALFLIT_SHARED)
    set(raster_libraries -lhalflit)
    set(io_flags -lhalflit_io)
    set(c_requires "")
    set(c_flags -lhalflit_c)
else()
    # Static libraries need their own dependencies at every link, not only with --static.
    get_property(io_flags GLOBAL PROPERTY HALFLIT_IO_FLAGS)
    list(JOIN io_flags " " io_flags)
    set(io_flags "-lhalflit_io ${io_flags}")
    set(c_requires halflit)
    set(c_flags -lhalflit_c)
    if(TARGET halflit_engine)
        set(c_requires halflit-io)
        get_property(engine_flags GLOBAL PROPERTY HALFLIT_ENGINE_FLAGS)
        list(JOIN engine_flags " " engine_flags)
        string(APPEND c_flags " -lhalflit_engine ${engine_flags}")
    endif()
    set(raster_libraries "-lhalflit_raster -lhalflit_shading -lhalflit_sh -pthread -lstdc++ -lm")
endif()
if(HALFLIT_ATOMIC_LIBRARY)
    string(APPEND raster_libraries " -latomic")
endif()
halflit_pkg_config(halflit "scenes and pictures in memory" "${raster_libraries}" "")
if(TARGET halflit::io)
    halflit_pkg_config(halflit-io "models, pictures and environments as files" "${io_flags}" halflit)
endif()
if(TARGET halflit::c)
    halflit_pkg_config(halflit-c "the C interface" "${c_flags}" "${c_requires}")
endif()

# The program. HALFLIT_BUNDLE: with the libraries that a bare system lacks beside it.
option(HALFLIT_BUNDLE "Install the shared libraries that the program needs beside it" OFF)
if(TARGET halflit)
    set(program_targets halflit)
    if(TARGET halflit_codecs)
        list(APPEND program_targets halflit_codecs)
    endif()
    if(HALFLIT_BUNDLE)
        set_target_properties(halflit PROPERTIES INSTALL_RPATH "${HALFLIT_ORIGIN}/../${CMAKE_INSTALL_LIBDIR}/halflit")
        if(TARGET halflit_codecs)
            set_target_properties(halflit_codecs PROPERTIES INSTALL_RPATH "${HALFLIT_ORIGIN}")
        endif()
        install(TARGETS ${program_targets}
            RUNTIME_DEPENDENCIES
                PRE_EXCLUDE_REGEXES "^lib(c|m|dl|pthread|rt|stdc\\+\\+|gcc_s)\\.so" "^ld-linux"
                DIRECTORIES /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}
            RUNTIME COMPONENT program
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/halflit COMPONENT program)
        get_property(libraries GLOBAL PROPERTY HALFLIT_LIBRARIES)
        list(JOIN libraries " " libraries)
        install(CODE "
            set(root \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
            execute_process(COMMAND ${CMAKE_COMMAND} \"-DBUNDLE=\${root}/${CMAKE_INSTALL_LIBDIR}/halflit\"
                \"-DINTO=\${root}/${CMAKE_INSTALL_DOCDIR}/licences\" \"-DDEPENDENCIES=${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake\"
                \"-DLIBRARIES=${libraries}\" -P \"${PROJECT_SOURCE_DIR}/cmake/licences.cmake\"
                COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
    else()
        install(TARGETS ${program_targets}
            RUNTIME COMPONENT program
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/halflit COMPONENT program)
    endif()
    # File managers show models as their pictures.
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/desktop/halflit.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers
        COMPONENT program)
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/desktop/halflit.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
    # Manual pages and completions come from the program's own tables, so it must run on this machine.
    if(NOT CMAKE_CROSSCOMPILING)
        set(pages ${PROJECT_BINARY_DIR}/pages)
        add_custom_command(OUTPUT ${pages}/halflit.1 ${pages}/halflit.bash ${pages}/_halflit ${pages}/halflit.fish
            COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:halflit> -DPAGES=${pages} -P ${PROJECT_SOURCE_DIR}/cmake/pages.cmake
            DEPENDS halflit ${PROJECT_SOURCE_DIR}/cmake/pages.cmake)
        add_custom_target(halflit_pages ALL DEPENDS ${pages}/halflit.1)
        install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1")
        install(FILES ${pages}/halflit.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME halflit
            COMPONENT program)
        install(FILES ${pages}/_halflit DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
        install(FILES ${pages}/halflit.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
    endif()
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/docs/SKILL.md ${PROJECT_SOURCE_DIR}/llms.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
if(TARGET halflit)
    install(FILES ${PROJECT_SOURCE_DIR}/apps/engine/fonts/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.dejavu-fonts
        COMPONENT program)
endif()

# Packages: `./dev package`.
if(NOT PROJECT_IS_TOP_LEVEL)
    return()
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libexpected-dev)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS libsdl2-2.0-0)  # loaded by halflit view alone
set(CPACK_PACKAGE_NAME halflit)
set(CPACK_PACKAGE_VENDOR "The halflit authors")
set(CPACK_PACKAGE_CONTACT "The halflit authors")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The halflit authors <halflit@invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_FILE_NAME halflit-${PROJECT_VERSION}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DESCRIPTION "halflit draws models, such as glTF, STL, PLY, OBJ and 3MF, without a GPU. The
same scene gives the same pixels on every machine. This package has the
program, the libraries and the headers.")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/documents.cmake)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
