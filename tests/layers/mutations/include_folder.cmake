# expect: layer 'render' must not use layer 'ingest': nepho_[a-z_]+ -> [^ ]*/ingest
target_include_directories(nepho_tree PRIVATE ${PROJECT_SOURCE_DIR}/render/../ingest)
