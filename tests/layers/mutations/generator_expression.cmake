# expect: layer 'render' must not use layer 'ingest': nepho_[a-z_]+ -> nepho_source_api
target_link_libraries(nepho_tree PUBLIC $<BUILD_INTERFACE:nepho::source_api>)
