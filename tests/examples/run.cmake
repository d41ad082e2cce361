# Runs an example and compares its picture with the one in docs/library.md. One code may differ: some examples use the C library's sine.
#   cmake -DEXAMPLE=program -DARGUMENTS=list -DOUTPUT=folder -DACTUAL=file -DEXPECTED=picture -DHALFLIT=program -P run.cmake
file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT})
execute_process(COMMAND ${EXAMPLE} ${ARGUMENTS} WORKING_DIRECTORY ${OUTPUT} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${HALFLIT} diff ${EXPECTED} ${OUTPUT}/${ACTUAL} --max 1 RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${OUTPUT}/${ACTUAL} differs from ${EXPECTED}")
endif()
