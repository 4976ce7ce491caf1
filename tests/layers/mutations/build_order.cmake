# expect: layer 'ingest' must not use layer 'render': nepho_[a-z_]+ -> nepho_tree
add_dependencies(nepho_source_api nepho_tree)
