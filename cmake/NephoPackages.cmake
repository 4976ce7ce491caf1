# Optional packages: NEPHO_WITH_X = AUTO | ON | OFF. AUTO prints what was dropped; ON stops where it
# is missing. Each package is then found in the one folder that uses it.
function(nepho_package_option name what)
  set(NEPHO_WITH_${name} AUTO CACHE STRING "${what}: AUTO, ON or OFF")
  set_property(CACHE NEPHO_WITH_${name} PROPERTY STRINGS AUTO ON OFF)
endfunction()
nepho_package_option(OPENVDB "OpenVDB files (.vdb)")
nepho_package_option(NETCDF "Forecasts in NetCDF files (.nc)")
nepho_package_option(GRIB "Forecasts in GRIB files (.grib, .grb, .grib2, .grb2)")
nepho_package_option(GDAL "Rasters of clouds and heights of ground (.tif, .vrt, .img, .asc, .hgt)")
nepho_package_option(PROJ "Map projections beyond GeographicLib's, through PROJ")
nepho_package_option(WINDOW "The window of nephoscope view, through GLFW and Dear ImGui")
nepho_package_option(OIIO "PNG, EXR and HDR pictures through OpenImageIO")

# nepho_package_missing(OPENVDB "text"): says so, or stops.
function(nepho_package_missing name what)
  if(NEPHO_WITH_${name} STREQUAL ON)
    message(FATAL_ERROR "NEPHO_WITH_${name}=ON, but ${what}")
  endif()
  message(STATUS "nephoscope: left out ${name}: ${what}")
endfunction()
