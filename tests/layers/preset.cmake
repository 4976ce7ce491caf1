# cmake -DSRC= -DOUT= -DPRESET= -DWANTED=regex -P preset.cmake: the preset configures, and what it
# promises stands in the cache.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${OUT})
execute_process(COMMAND ${CMAKE_COMMAND} --preset ${PRESET} -S ${SRC} -B ${OUT} ${OPTIONS}
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(NOTICE "${output}")
  message(FATAL_ERROR "preset ${PRESET} does not configure")
endif()
file(STRINGS ${OUT}/CMakeCache.txt kept REGEX "${WANTED}")
file(STRINGS ${OUT}/build.ninja compiled REGEX "${FLAGS}" LIMIT_COUNT 1)
if(NOT kept OR NOT compiled)
  message(FATAL_ERROR "preset ${PRESET}: no '${WANTED}' in the cache or no '${FLAGS}' in the rules")
endif()
message(STATUS "${PRESET}: ${kept}; compiles with ${FLAGS}")
file(REMOVE_RECURSE ${OUT})
