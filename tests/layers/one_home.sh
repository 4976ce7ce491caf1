#!/bin/sh
# one_home.sh ROOT: each heavy package is looked for in one CMakeLists.txt, and its headers are
# included in that folder only. A package without any home is a stale row, which fails as well.
set -eu
cd "$1"
failed=0
check() {  # check FOLDERS FIND_REGEX INCLUDE_REGEX, FOLDERS separated by |
  homes=$(grep -rlE --include=CMakeLists.txt "$2" formats render ingest tools tests || true)
  if [ -z "$homes" ]; then
    echo "one_home: nobody looks for $2"
    failed=1
  fi
  users=$(grep -rlE --include=*.h --include=*.cpp "#include [<\"]$3" formats render ingest tools tests || true)
  for file in $homes $users; do
    if ! echo "$file" | grep -qE "^($1)/"; then
      echo "one_home: $file uses $2, which belongs into $1"
      failed=1
    fi
  done
  echo "one_home: $1: $(echo "$homes" | wc -w) find it, $(echo "$users" | wc -w) include it"
}
check 'ingest/sources/openvdb|tests/openvdb' 'find_package\(OpenVDB' 'openvdb/'
check 'ingest/sources/netcdf|tests/netcdf' 'find_package\(netCDF' '(netcdf|hdf5)\.h'
check 'ingest/sources/grib|tests/grib' 'find_package\(eccodes' 'eccodes\.h'
check 'ingest/sources/gdal|tests/gdal' 'find_path\(NEPHO_GDAL' '(gdal|ogr|cpl)_[a-z_]*\.h'
check 'tools/image/oiio' 'find_(package|path)\(.*OpenImageIO' 'OpenImageIO/'
check 'tools/view/window' 'find_package\(glfw3|pkg_check_modules\(IMGUI' '(GLFW/|imgui|backends/imgui)'
check 'ingest/geo|tests' 'find_package\(GeographicLib' 'GeographicLib/'
check 'ingest/geo' 'find_package\(PROJ' 'proj\.h'
check 'tools/sun' 'find_path\(LIBNOVA' 'libnova/'
check 'tools' 'find_package\(CLI11' 'CLI/'
check 'tests/support' 'find_package\(Boost' 'boost/'
check 'tools|tests' 'find_package\(nlohmann_json' 'nlohmann/'
exit $failed
