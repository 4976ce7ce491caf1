# expect: layer 'ingest' must not use layer 'render': nepho_source_api -> nepho_tree
target_link_libraries(nepho_source_api PRIVATE nepho::tree)
