# Flags of every own target, and where binaries go.
option(NEPHO_WERROR "Treat warnings as errors" OFF)
set(NEPHO_SANITIZE "" CACHE STRING "Sanitizers, separated by ;")
option(NEPHO_BUILD_TESTS "Build the tests" ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()
# -g1 keeps line numbers for backtraces at a fifth of the object size.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1 -DNDEBUG")

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(NEPHO_MODULE_DIR ${CMAKE_BINARY_DIR}/lib/nephoscope)

# GCC 12 drops the rounding in a pair of double(float(x)) when it vectorises straight-line code
# (struct {double a, b;} = {double(float(.1)), ...} keeps 0.1): wrong code at plain -O2.
add_compile_options(-fno-tree-slp-vectorize)
# The same bits on every machine: no fused multiply-add that the source does not ask for.
add_compile_options(-Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)
if(NEPHO_WERROR)
  add_compile_options(-Werror)
endif()
foreach(sanitizer IN LISTS NEPHO_SANITIZE)
  add_compile_options(-fsanitize=${sanitizer} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${sanitizer})
endforeach()

find_program(NEPHO_CCACHE ccache)
if(NEPHO_CCACHE)
  # Paths relative to the tree: a copy of it elsewhere (tests/layers, a second clone) compiles from
  # the same cache. Debug information then names the first copy's folder, line numbers hold.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${NEPHO_CCACHE})
endif()
