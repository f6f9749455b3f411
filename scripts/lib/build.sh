# Builds a dependency once and keeps it. Source this file; it needs `say`, $cache and $work.

# cache_prefix NAME RECIPE...: where that build is, or would be, kept. A different compiler, machine or recipe is a
# different place.
cache_prefix() {
  local name=$1 key
  shift
  key=$({
    "${CC:-cc}" --version | sed 's/^[^ ]* //;q' # without the name it was called by
    "${CXX:-c++}" --version | sed 's/^[^ ]* //;q'
    uname -m
    printf '%s\n' "$@"
  } | sha256sum | cut -c 1-12)
  echo "$cache/$name-$key"
}

is_built() { [ -e "$1/.complete" ]; }

# with_progress NAME LOG COMMAND...: runs the command with its output at the end of LOG, and says now and then how far its ninja is.
with_progress() {
  local name=$1 log=$2 pid second far
  shift 2
  "$@" >>"$log" 2>&1 &
  pid=$!
  while :; do
    for ((second = 0; second < 15; second++)); do
      sleep 1
      kill -0 "$pid" 2>/dev/null || break 2
    done
    far=$(sed -n 's|^\[\([0-9]*\)/\([0-9]*\)\].*|\1 of \2 steps|p' "$log" | tail -n 1)
    say "$name: ${far:-building}"
  done
  wait "$pid"
}

# build_with_cmake NAME SOURCE PREFIX OPTION...
build_with_cmake() {
  local name=$1 source=$2 prefix=$3 build
  shift 3
  build=$(mktemp -d "$work/build.XXXXXX")
  rm -rf "$prefix"
  if ! {
    cmake -S "$source" -B "$build" -G Ninja -DCMAKE_INSTALL_PREFIX="$prefix" "$@" >"$build.log" 2>&1 &&
      with_progress "$name" "$build.log" cmake --build "$build" --parallel "${GRIDMORPH_JOBS:-$(nproc)}" &&
      cmake --install "$build" >>"$build.log" 2>&1
  }; then
    tail -n 40 "$build.log" >&2
    return 1
  fi
  touch "$prefix/.complete"
}

# unpack ARCHIVE [PATH]: unpacks the archive, or the part of it below PATH, and prints the folder of its topmost
# CMakeLists.txt.
unpack() {
  local archive=$1 path=${2:-} folder
  folder=$(mktemp -d "$work/source.XXXXXX")
  tar -xf "$archive" -C "$folder" ${path:+--wildcards "*/$path/*"} || return 1
  find "$folder" -name CMakeLists.txt -printf '%d %h\n' | sort -n | sed -n '1s/^[0-9]* //p'
}

# fetch_release URL SHA256 FILE: downloads with CMake, which is always there, and refuses a file with another hash.
fetch_release() {
  local script="$3.cmake" log="$3.log"
  cat >"$script" <<EOF
file(DOWNLOAD "$1" "$3" INACTIVITY_TIMEOUT 10 TIMEOUT 300 STATUS status)
list(GET status 0 code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "\${status}")
endif()
file(SHA256 "$3" hash)
if(NOT hash STREQUAL "$2")
  message(FATAL_ERROR "the SHA-256 hash of the download is \${hash}, not $2")
endif()
EOF
  if ! cmake -P "$script" >"$log" 2>&1; then
    say "no download of $1: $(sed -n '/^  /{s/^ *//p;q}' "$log")"
    return 1
  fi
}
