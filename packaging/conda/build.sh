#!/usr/bin/env bash
# What recipe.yaml runs: $PREFIX and $CMAKE_ARGS are conda's.
set -euxo pipefail
# shellcheck disable=SC2086  # words of a command line
cmake -S . -B build -G Ninja ${CMAKE_ARGS:-} \
  -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_INSTALL_PREFIX="$PREFIX" \
  -DCMAKE_INSTALL_LIBDIR=lib \
  -DCMAKE_PREFIX_PATH="$PREFIX" \
  -DGRIDMORPH_ENABLE_TESTS=OFF \
  -DGRIDMORPH_ENABLE_BENCHMARKS=OFF \
  -DGRIDMORPH_ENABLE_EXAMPLES=OFF \
  -DGRIDMORPH_UNITY_BUILD=ON
cmake --build build --parallel "${CPU_COUNT:-2}"
cmake --install build
