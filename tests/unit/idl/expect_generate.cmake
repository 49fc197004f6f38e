# Runs idl/generate.cmake and expects it to succeed or to fail with a message.
# cmake -DGENERATE=<generate.cmake> -DFASTDDSGEN=<program> -DIDL=<file> -DOUTPUT=<folder>
#       [-DEXPECTED_ERROR=<regular expression>] -P expect_generate.cmake
get_filename_component(stem ${IDL} NAME_WE)
file(MAKE_DIRECTORY ${OUTPUT})
# Files of an earlier run must not pass for new ones.
file(WRITE ${OUTPUT}/${stem}.h "stale")
file(WRITE ${OUTPUT}/${stem}.cxx "stale")
execute_process(COMMAND ${CMAKE_COMMAND} -DFASTDDSGEN=${FASTDDSGEN} -DIDL=${IDL} -DOUTPUT=${OUTPUT} -P ${GENERATE}
  RESULT_VARIABLE exit_status OUTPUT_VARIABLE text ERROR_VARIABLE text)
if(NOT EXPECTED_ERROR)
  if(NOT exit_status EQUAL 0)
    message(FATAL_ERROR "a good IDL was refused:\n${text}")
  endif()
  file(READ ${OUTPUT}/${stem}.h header)
  if(NOT header MATCHES "class Good")
    message(FATAL_ERROR "no class in ${OUTPUT}/${stem}.h")
  endif()
  return()
endif()
if(exit_status EQUAL 0)
  message(FATAL_ERROR "${IDL} was accepted:\n${text}")
endif()
if(NOT text MATCHES "${EXPECTED_ERROR}")
  message(FATAL_ERROR "${IDL} was refused, but not for \"${EXPECTED_ERROR}\":\n${text}")
endif()
if(EXISTS ${OUTPUT}/${stem}.h OR EXISTS ${OUTPUT}/${stem}.cxx)
  message(FATAL_ERROR "files of a failed run are left in ${OUTPUT}")
endif()
