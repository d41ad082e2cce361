# Run by cpack on the tree of a .deb: the documents that Debian asks of every package, by its names, and compressed manual pages.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
    return()
endif()
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(documents ${root}/share/doc/${CPACK_PACKAGE_NAME})
set(debian ${CMAKE_CURRENT_LIST_DIR}/../../packaging/debian)
file(COPY ${debian}/copyright DESTINATION ${documents})
file(COPY_FILE ${debian}/changelog ${documents}/changelog)
file(REMOVE ${documents}/LICENSE ${documents}/LICENSE.dejavu-fonts)  # in the copyright file
file(GLOB pages ${root}/share/man/man1/*.1)
execute_process(COMMAND gzip -9nf ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
# Debian's folder of completions for zsh.
if(EXISTS ${root}/share/zsh/site-functions)
    file(RENAME ${root}/share/zsh/site-functions ${root}/share/zsh/vendor-completions)
endif()
