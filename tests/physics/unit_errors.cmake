# cmake -DCOMPILER= -DSOURCE_DIR= -DWORK_DIR= -P unit_errors.cmake
# Copies the shared equations, plants one unit error at a time, and compiles physics_cpp.h: it must
# fail, in the planted file, with a message that names the two dimensions. The untouched copy, and
# every planted one with the dimension-checked build left out, must compile.
cmake_minimum_required(VERSION 3.25)

function(compile_copy out_result out_text)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C ${COMPILER} -std=c++20 -fsyntax-only ${ARGN} -I${WORK_DIR}
    -I${SOURCE_DIR}/formats -x c++ ${WORK_DIR}/check.cpp
    RESULT_VARIABLE result ERROR_VARIABLE text OUTPUT_QUIET)
  set(${out_result} ${result} PARENT_SCOPE)
  set(${out_text} "${text}" PARENT_SCOPE)
endfunction()

function(fresh_copy)
  file(REMOVE_RECURSE ${WORK_DIR})
  file(MAKE_DIRECTORY ${WORK_DIR})
  file(COPY ${SOURCE_DIR}/render/physics DESTINATION ${WORK_DIR})
  file(WRITE ${WORK_DIR}/check.cpp "#include \"physics/physics_cpp.h\"\n")
endfunction()

# plant(file old new message): `message` is a regular expression of the compiler's complaint.
function(plant file old new message)
  fresh_copy()
  file(READ ${WORK_DIR}/physics/${file} text)
  string(REPLACE "${old}" "${new}" planted "${text}")
  if(planted STREQUAL text)
    message(FATAL_ERROR "${file} has no '${old}' to replace: move the planted error along")
  endif()
  file(WRITE ${WORK_DIR}/physics/${file} "${planted}")
  compile_copy(result complaint)
  if(result EQUAL 0)
    message(FATAL_ERROR "${file}: '${new}' compiled")
  endif()
  if(NOT complaint MATCHES "${file}:[0-9]+:[0-9]+: error: ${message}")
    message(FATAL_ERROR "${file}: '${new}' failed for another reason:\n${complaint}")
  endif()
  # Plain numbers do not see it: it was a unit error, not one of syntax.
  file(READ ${WORK_DIR}/physics/physics_cpp.h header)
  string(REGEX REPLACE "namespace nepho::dim {.*}  // namespace nepho::dim" "" header "${header}")
  file(WRITE ${WORK_DIR}/physics/physics_cpp.h "${header}")
  compile_copy(result complaint)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${file}: '${new}' is no unit error:\n${complaint}")
  endif()
  message(STATUS "stopped: ${file}: ${new}")
endfunction()

fresh_copy()
compile_copy(result complaint)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "control: the untouched equations do not compile:\n${complaint}")
endif()

plant(transport.glsl "d * (k0 +" "d + (k0 +"
  "no match for 'operator.' .operand types are .*Quantity<1, 0, 0>.* and .*Quantity<-1, 0, 0>")
plant(transport.glsl "s1 - s0" "s1 - tau" "no match for 'operator-'")
plant(phase.glsl "return shape * InverseSolidAngle(" "return shape * Number(" "could not convert")
plant(shell.glsl "radius * radius + rise" "radius + rise" "no match for 'operator.'")
plant(walls.glsl "radius * s / across" "radius * radius * s / across" "conversion from")
plant(sky.glsl "(zenith - horizon) * (" "zenith * (zenith - horizon) * (" "no match for 'operator.'")
