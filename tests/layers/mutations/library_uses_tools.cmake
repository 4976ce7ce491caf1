# expect: layer 'render' must not use layer 'tools': nepho_[a-z_]+ -> nepho_gl_context
target_link_libraries(nepho_tree PUBLIC nepho::gl_context)
