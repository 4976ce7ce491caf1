# cmake -DSRC= -DOUT= -DLAYERS=formats;render [-DPLANT=mutation.cmake] [-DPLANT_FILE= -DPLANT_TEXT=]
#       [-DBUILD=target,...] [-DRUN=regex] [-DEXPECT=regex] [-DOPTIONS=...] -P nested.cmake
# Copies some layers into an empty tree, where nothing else can be found by any path, with the real
# top-level CMakeLists.txt less the absent layers, then configures, builds and tests it.
#   PLANT       is included just before nepho_check_layers(); its first line is "# expect: regex"
#   PLANT_FILE  gets PLANT_TEXT as its first line
#   RUN         names of the tests to run; without it no tests are configured
#   EXPECT      (or PLANT's) must appear and the run must fail; without it the run must succeed
# The build folder has the depth of build/<preset>, so that ccache knows the relative paths again.
cmake_minimum_required(VERSION 3.25)
set(tree ${OUT}/src)
set(build ${tree}/build/nested)
file(REMOVE_RECURSE ${tree})
foreach(layer cmake ${LAYERS})
  file(COPY ${SRC}/${layer} DESTINATION ${tree})
endforeach()

file(READ ${SRC}/CMakeLists.txt top)
foreach(layer formats render ingest tools tests)
  if(NOT layer IN_LIST LAYERS)
    string(REPLACE "add_subdirectory(${layer})" "" top "${top}")
  endif()
endforeach()
if(PLANT)
  file(STRINGS ${PLANT} first LIMIT_COUNT 1)
  string(REGEX REPLACE "^# expect: " "" EXPECT "${first}")
  string(REPLACE "\nnepho_check_layers()" "\ninclude(${PLANT})\nnepho_check_layers()" planted "${top}")
  if(planted STREQUAL top)
    message(FATAL_ERROR "CMakeLists.txt no longer ends with nepho_check_layers()")
  endif()
  set(top "${planted}")
endif()
file(WRITE ${tree}/CMakeLists.txt "${top}")
if(PLANT_FILE)
  file(READ ${tree}/${PLANT_FILE} text)
  file(WRITE ${tree}/${PLANT_FILE} "${PLANT_TEXT}\n${text}")
endif()

# run(<step> <command>...): ends the script where the step fails, for the expected reason or not.
function(run step)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${tree} RESULT_VARIABLE status
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(status EQUAL 0)
    message(STATUS "${step}: passed")
    return()
  endif()
  string(REGEX REPLACE "[ \n]+" " " one_line "${output}")  # CMake folds its messages
  if(EXPECT AND one_line MATCHES "${EXPECT}")
    message(STATUS "${step}: stopped as it must: ${CMAKE_MATCH_0}")
    set(stopped TRUE PARENT_SCOPE)
  else()
    message(NOTICE "${output}")
    message(FATAL_ERROR "${step} failed, expected '${EXPECT}'")
  endif()
endfunction()

set(stopped FALSE)
if(NOT RUN)
  list(APPEND OPTIONS -DNEPHO_BUILD_TESTS=OFF)
endif()
run(configure ${CMAKE_COMMAND} -S ${tree} -B ${build} -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo
    -DCMAKE_CXX_COMPILER=${COMPILER} ${OPTIONS})
if(BUILD AND NOT stopped)
  string(REPLACE "," ";" BUILD "${BUILD}")
  run(build ${CMAKE_COMMAND} --build ${build} --target ${BUILD})
endif()
if(RUN AND NOT stopped)
  run(test ${CMAKE_CTEST_COMMAND} --test-dir ${build} --no-tests=error --output-on-failure -R ${RUN}
      -LE "^slow$|^layers$")
endif()
if(EXPECT AND NOT stopped)
  message(FATAL_ERROR "nothing stopped it, expected: ${EXPECT}")
endif()
file(REMOVE_RECURSE ${OUT})
