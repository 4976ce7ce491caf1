# expect: layer 'render' must not use layer 'ingest': nepho_[a-z]+ -> nepho_source_api
add_library(nepho_helper INTERFACE)
target_link_libraries(nepho_helper INTERFACE nepho::source_api)
nepho_layer(nepho_helper render)
target_link_libraries(nepho_tree PRIVATE nepho_helper)
