# expect: layer 'formats' must not use layer 'ingest': nepho_[a-z_]+ -> nepho_source_api
target_link_libraries(nepho_formats PRIVATE nepho_source_api)
