# expect: target nepho_helper has no layer
add_library(nepho_helper INTERFACE)
target_link_libraries(nepho_helper INTERFACE nepho::source_api)
target_link_libraries(nepho_tree PRIVATE nepho_helper)
