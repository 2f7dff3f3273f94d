#!/bin/bash
# What cmake --install leaves behind: a program that runs and scene data, no sources.
#   install_test.sh CMAKE BUILD_DIR SOURCE_DIR
set -eu
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
"$1" --install "$2" --prefix "$prefix" >/dev/null
"$prefix/bin/obscura" version >/dev/null
test -f "$prefix/share/obscura/LICENSE"
sources=$(find "$prefix" \( -name '*.cpp' -o -name '*.h' -o -name 'CMakeLists.txt' \) -print)
if [ -n "$sources" ]; then
    printf 'sources were installed:\n%s\n' "$sources"
    exit 1
fi
for scene in "$3"/scenes/*.toml; do
    [ -e "$scene" ] || continue
    test -f "$prefix/share/obscura/scenes/$(basename "$scene")" || { echo "$scene was not installed"; exit 1; }
done
