# expect: layer 'render' must not use layer 'tools': nepho_tree -> nepho_gl_context
target_link_libraries(nepho_tree PUBLIC nepho::gl_context)
