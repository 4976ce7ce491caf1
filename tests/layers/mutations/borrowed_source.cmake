# expect: layer 'render' must not use layer 'ingest': nepho_[a-z_]+ -> [^ ]*/ingest/api/source_module.cpp
target_sources(nepho_tree PRIVATE ${PROJECT_SOURCE_DIR}/ingest/api/source_module.cpp)
