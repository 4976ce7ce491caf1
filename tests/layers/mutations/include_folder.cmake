# expect: layer 'render' must not use layer 'ingest': nepho_tree -> [^ ]*/ingest
target_include_directories(nepho_tree PRIVATE ${PROJECT_SOURCE_DIR}/render/../ingest)
