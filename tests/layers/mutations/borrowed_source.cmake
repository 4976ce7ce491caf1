# expect: layer 'render' must not use layer 'ingest': nepho_tree -> [^ ]*/ingest/api/source_module.cpp
target_sources(nepho_tree PRIVATE ${PROJECT_SOURCE_DIR}/ingest/api/source_module.cpp)
