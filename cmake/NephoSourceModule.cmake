# nepho_add_source_module(<id> SOURCES ... LIBS ... KEYS ...): a run-time MODULE and its manifest
# <id>.source, three lines that are read instead of dlopen: id, library, keys (what it answers to:
# its id and the file endings it reads).
function(nepho_add_source_module id)
  cmake_parse_arguments(A "" "" "SOURCES;LIBS;KEYS" ${ARGN})
  set(target nepho_source_${id})
  add_library(${target} MODULE ${A_SOURCES})
  target_link_libraries(${target} PRIVATE nepho::source_api ${A_LIBS})
  set_target_properties(${target} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${NEPHO_MODULE_DIR} BUILD_RPATH_USE_ORIGIN ON)
  if(NOT NEPHO_SANITIZE)  # a missing library is found here, not when a user opens a scene
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  list(JOIN A_KEYS " " keys)
  file(WRITE ${NEPHO_MODULE_DIR}/${id}.source "id ${id}\nlibrary ${target}.so\nkeys ${keys}\n")
  nepho_layer(${target} ingest)
endfunction()
