# cmake -DSRC= -DOUT= -DPRESET=asan|tsan -DPROGRAMS=a;b -DMODULES=a;b -P sanitized.cmake: builds what
# needs no OpenGL with a sanitizer and runs its test programs; a planted mistake shows that it is awake.
cmake_minimum_required(VERSION 3.25)
function(run step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(NOTICE "${output}")
    message(FATAL_ERROR "${PRESET}: ${step} failed")
  endif()
  string(REGEX MATCH "[0-9]+ tests from [^\n]*" summary "${output}")
  message(STATUS "${PRESET}: ${step} passed ${summary}")
endfunction()

run(configure ${CMAKE_COMMAND} --preset ${PRESET} -S ${SRC} -B ${OUT})
run(build ${CMAKE_COMMAND} --build ${OUT} --target ${PROGRAMS} ${MODULES} awake)
# The paths of CMakePresets.json's testPresets, which ctest --test-dir does not read.
set(ENV{TSAN_OPTIONS} "suppressions=${SRC}/cmake/tsan.supp:ignore_noninstrumented_modules=1")
set(ENV{LSAN_OPTIONS} "suppressions=${SRC}/cmake/lsan.supp")
set(ENV{UBSAN_OPTIONS} "suppressions=${SRC}/cmake/ubsan.supp:print_stacktrace=1:halt_on_error=1")
execute_process(COMMAND ${OUT}/tests/awake ${PRESET} RESULT_VARIABLE status ERROR_VARIABLE report)
if(status EQUAL 0 OR NOT report MATCHES "(AddressSanitizer: heap-buffer-overflow|ThreadSanitizer: data race)")
  message(FATAL_ERROR "${PRESET}: the planted mistake was not reported: ${report}")
endif()
message(STATUS "${PRESET}: awake: ${CMAKE_MATCH_0}")
foreach(program IN LISTS PROGRAMS)  # whole: each start of a sanitized process costs seconds
  run(${program} ${OUT}/tests/${program} --gtest_brief=1)
endforeach()
