# Writes the program's manual pages and completions into a folder.
#   cmake -DPROGRAM=halflit -DPAGES=folder -P pages.cmake
file(MAKE_DIRECTORY ${PAGES})
function(write_page file)
    execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${PAGES}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
foreach(command render info bench diff sheet golden lobe env figures trade)
    write_page(halflit-${command}.1 man ${command})
endforeach()
write_page(halflit.bash completion bash)
write_page(_halflit completion zsh)
write_page(halflit.fish completion fish)
write_page(halflit.1 man)
