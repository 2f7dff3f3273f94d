#!/bin/sh
# clang-tidy, with the rules of .clang-tidy, over the rooms whose code others build on: core, raster, hierarchy, filters.
# Usage: tidy_check.sh BUILD_DIR. It takes minutes, so it runs in CI and with OBSCURA_SLOW_TESTS=1; otherwise,
# and without clang-tidy 14, it exits 77, which counts as skipped.
set -eu
if [ "${CI:-}" != true ] && [ "${OBSCURA_SLOW_TESTS:-}" != 1 ]; then
    echo "skipped: takes minutes; set OBSCURA_SLOW_TESTS=1 to run it"
    exit 77
fi
if ! clang-tidy --version 2> /dev/null | grep -q 'version 14\.'; then
    echo "skipped: clang-tidy 14 is not installed"
    exit 77
fi
build=$(realpath "$1")
cd "$(dirname "$0")/.."
[ -f "$build/compile_commands.json" ] || { echo "no compile_commands.json in $build"; exit 1; }
# Not kernels, which are built once per instruction set; not image_io.cpp, which holds all of stb.
ls core/*.cpp raster/*.cpp hierarchy/*.cpp filters/*.cpp | grep -vE '_kernel\.cpp$|image_io\.cpp$' |
    xargs -n 4 -P "$(nproc)" clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option 2> /dev/null
