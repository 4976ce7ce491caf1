# Real files are never part of the project; the tests that read them exist where this names them.
set(NEPHO_REAL_DATA "$ENV{NEPHO_REAL_DATA}" CACHE PATH "Folder of real files; empty: synthetic only")

# nepho_add_tests(<name> LABELS ... SOURCES ... LIBS ... [DEFINES ...] [ENV ...] [FIXTURES ...]
# [WHOLE]): a GoogleTest program in the layer `tests`. One ctest entry per TEST, or one in all with
# WHOLE (for programs whose set-up costs more than their tests: an OpenGL context, a compiled
# shader). FIXTURES are ctest's FIXTURES_REQUIRED.
function(nepho_add_tests name)
  cmake_parse_arguments(A "WHOLE" "" "LABELS;SOURCES;LIBS;DEFINES;ENV;FIXTURES" ${ARGN})
  nepho_add_test_program(${name} SOURCES ${A_SOURCES} LIBS ${A_LIBS} DEFINES ${A_DEFINES})
  if(A_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${A_LABELS}" ENVIRONMENT "${A_ENV}"
      FIXTURES_REQUIRED "${A_FIXTURES}")
    return()
  endif()
  # gtest_discover_tests flattens lists of values, so properties are set after it, for the names
  # that it leaves behind.
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${name}. TEST_LIST ${name}_TESTS)
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}_properties.cmake)
  file(WRITE ${script} "set_tests_properties(\${${name}_TESTS} PROPERTIES LABELS \"${A_LABELS}\"
  ENVIRONMENT \"${A_ENV}\" FIXTURES_REQUIRED \"${A_FIXTURES}\")\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()

function(nepho_add_test_program name)
  cmake_parse_arguments(A "" "" "SOURCES;LIBS;DEFINES" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_LIBS} nepho::test_support
    GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE ${A_DEFINES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  nepho_layer(${name} tests)
endfunction()

# nepho_add_mutant(<name> [OF <program>] MUTANT <macro> FILTER <gtest filter> [REASON <regex>]
# LABELS ... SOURCES ... LIBS ...): the same tests compiled with a planted mistake; they must fail.
# Counted, and the number is printed at configure time.
#   OF      program in which the same filter must pass, as control.<name>: built without the macro
#   REASON  what the output must hold, so that a crash or a missing file does not count as a failure
function(nepho_add_mutant name)
  cmake_parse_arguments(A "" "OF;MUTANT;FILTER;REASON" "LABELS;SOURCES;LIBS;DEFINES;ENV" ${ARGN})
  nepho_add_test_program(${name} SOURCES ${A_SOURCES} LIBS ${A_LIBS}
    DEFINES ${A_DEFINES} ${A_MUTANT})
  add_test(NAME mutant.${name} COMMAND ${name} --gtest_filter=${A_FILTER})
  set_tests_properties(mutant.${name} PROPERTIES LABELS "${A_LABELS};mutant" ENVIRONMENT "${A_ENV}")
  if(A_REASON)
    set_tests_properties(mutant.${name} PROPERTIES PASS_REGULAR_EXPRESSION "${A_REASON}")
  else()
    set_tests_properties(mutant.${name} PROPERTIES WILL_FAIL ON)
  endif()
  if(A_OF)
    add_test(NAME control.${name} COMMAND ${A_OF} --gtest_filter=${A_FILTER})
    set_tests_properties(control.${name} PROPERTIES LABELS "${A_LABELS}" ENVIRONMENT "${A_ENV}"
      FAIL_REGULAR_EXPRESSION "${A_REASON};Running 0 tests")
  endif()
  set_property(GLOBAL APPEND PROPERTY NEPHO_MUTANTS ${name})
endfunction()
