# Runs the example that draws figures, and compares them with the committed ones.
#   cmake -DEXAMPLE=program -DOUTPUT=folder -DEXPECTED=folder -P figures.cmake
file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT})
execute_process(COMMAND ${EXAMPLE} ${OUTPUT} COMMAND_ERROR_IS_FATAL ANY)
foreach(figure lobes shadows edge)
    execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files --ignore-eol ${OUTPUT}/figure_${figure}.svg ${EXPECTED}/figure_${figure}.svg
        COMMAND_ERROR_IS_FATAL ANY)
endforeach()
