# expect: layer 'ingest' must not use layer 'render': nepho_source_api -> nepho_tree
add_dependencies(nepho_source_api nepho_tree)
