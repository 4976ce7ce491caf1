# expect: layer 'ingest' must not use layer 'render': nepho_[a-z_]+ -> nepho_tree
target_link_libraries(nepho_source_api PRIVATE nepho::tree)
