# How Kokkos and CGNS are obtained where they are not installed: Debian 12 and 13 have neither in a form that gridmorph can use.
# Source this file; it needs apt.sh and build.sh.

kokkos_options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DKokkos_ENABLE_SERIAL=ON
  -DKokkos_ENABLE_OPENMP=ON)
cgns_options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCGNS_BUILD_SHARED=OFF
  -DCGNS_ENABLE_HDF5=ON -DCGNS_ENABLE_PARALLEL=OFF -DCGNS_ENABLE_FORTRAN=OFF -DCGNS_ENABLE_TESTS=OFF
  -DCGNS_BUILD_CGNSTOOLS=OFF)

# The ways to the sources, in the order they are tried. Each prints the source folder, or fails.
kokkos_routes=(release debian trilinos)
kokkos_release() {
  unpack_release https://github.com/kokkos/kokkos/releases/download/5.0.2/kokkos-5.0.2.tar.gz \
    188817bb452ca805ee8701f1c5adbbb4fb83dc8d1c50624566a18a719ba0fa5e
}
kokkos_debian() { unpack_debian_source kokkos unstable; }
kokkos_trilinos() { unpack_debian_source trilinos bookworm packages/kokkos; } # Kokkos 3.4.1
# It leaves an include to the standard library of g++ 12 and older. No part of cache_prefix: what is built with it or without is the same.
kokkos_trilinos_more=(-DCMAKE_CXX_FLAGS="-include cstdint")

cgns_routes=(release debian)
cgns_release() {
  unpack_release https://github.com/CGNS/CGNS/archive/v4.5.0.tar.gz \
    c72355219318755ba0a8646a8e56ee1c138cf909c1d738f258d2774fa4b529e9
}
cgns_debian() { unpack_debian_source libcgns testing; }

# unpack_release URL SHA256
unpack_release() {
  local archive
  archive=$(mktemp "$work/release.XXXXXX") && fetch_release "$1" "$2" "$archive" && unpack "$archive"
}

# unpack_debian_source PACKAGE SUITE [PATH]
unpack_debian_source() {
  local archive
  archive=$(fetch_debian_source "$1" "$2" "$work/$1") && unpack "$archive" "${3:-}"
}

# route_prefix NAME ROUTE: where the build by that route is kept.
route_prefix() {
  local -n of_name=${1}_options
  cache_prefix "$1-$2" "$(declare -f "${1}_$2")" "${of_name[@]}"
}

# is_provided NAME: whether there is a finished build of it; prints its prefix.
is_provided() {
  local route prefix
  local -n routes_of_name=${1}_routes
  for route in "${routes_of_name[@]}"; do
    prefix=$(route_prefix "$1" "$route")
    if is_built "$prefix"; then
      echo "$prefix"
      return 0
    fi
  done
  return 1
}

# provide NAME: prints the prefix of a build of kokkos or cgns; looks for a finished one on every route before it makes one.
provide() {
  local name=$1 route prefix source more
  local -n routes=${name}_routes options=${name}_options
  is_provided "$name" && return 0
  for route in "${routes[@]}"; do
    prefix=$(route_prefix "$name" "$route")
    say "$name: looking for the sources ($route)"
    source=$("${name}_$route") || continue
    say "$name: building $prefix (once, about a minute on two cores)"
    more="${name}_${route}_more[@]"
    if build_with_cmake "$name" "$source" "$prefix" "${options[@]}" "${!more}"; then
      echo "$prefix"
      return 0
    fi
    say "$name: the build failed, see above"
  done
  return 1
}
