# What every script does first. Source this file; it leaves you in the project's root with the dependencies in place.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

jobs=${GRIDMORPH_JOBS:-$(nproc)}

# Compiling again what was compiled before, in this folder or in another one, takes no time where ccache is installed.
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
  export CCACHE_BASEDIR=${CCACHE_BASEDIR-$PWD} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR-true}
  export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS-pch_defines,time_macros}
fi

# use_dependencies [install-dependencies option...]
use_dependencies() {
  CMAKE_PREFIX_PATH=$(scripts/install-dependencies "$@")
  export CMAKE_PREFIX_PATH
}

# build PRESET [TARGET [cmake option...]]: configures and builds.
build() {
  cmake --preset "$1" "${@:3}"
  cmake --build --preset "$1" --parallel "$jobs" ${2:+--target "$2"}
}

# step TEXT...: says what comes next, and how many seconds have passed.
step() { printf '\n== %s (%d s so far)\n' "$*" "$SECONDS" >&2; }
