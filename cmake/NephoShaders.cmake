# nepho_embed_shaders(<target> INCLUDE_DIRS ... SHADERS a.comp ...): flattens `#include "x.glsl"` (GL
# 4.5 core has none) with #line kept and embeds each shader as `extern const char* const
# nepho_shader_<name>`.
# In `#line N S`, S numbers the files in the order of the comment at the shader's head.
set(NEPHO_FLATTEN_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/flatten_shader.cmake)
find_program(NEPHO_GLSLANG glslangValidator)

function(nepho_embed_shaders target)
  cmake_parse_arguments(A "" "" "INCLUDE_DIRS;SHADERS" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/shaders)
  set(parts "")
  foreach(dir IN LISTS A_INCLUDE_DIRS)
    file(GLOB more CONFIGURE_DEPENDS ${dir}/*.glsl)
    list(APPEND parts ${more})
  endforeach()
  foreach(shader IN LISTS A_SHADERS)
    get_filename_component(name ${shader} NAME_WE)
    add_custom_command(OUTPUT ${out}/${name}.cpp ${out}/${name}.comp
      COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DSHADER=${CMAKE_CURRENT_SOURCE_DIR}/${shader}
              "-DINCLUDE_DIRS=${A_INCLUDE_DIRS}" -DOUT=${out} -P ${NEPHO_FLATTEN_SCRIPT}
      DEPENDS ${shader} ${parts} ${NEPHO_FLATTEN_SCRIPT} VERBATIM)
    target_sources(${target} PRIVATE ${out}/${name}.cpp)
    set_property(GLOBAL APPEND PROPERTY NEPHO_FLAT_SHADERS ${out}/${name}.comp)
  endforeach()
endfunction()
