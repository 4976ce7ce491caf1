# expect: layer 'render' must not use layer 'ingest': nepho_tree -> nepho_source_analytic
add_dependencies(nepho_tree nepho_source_analytic)
