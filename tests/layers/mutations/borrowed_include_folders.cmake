# expect: layer 'render' must not use layer 'ingest': nepho_[a-z_]+ -> nepho_source_api
target_include_directories(
  nepho_tree PRIVATE $<TARGET_PROPERTY:nepho_source_api,INTERFACE_INCLUDE_DIRECTORIES>)
