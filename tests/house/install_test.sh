#!/bin/bash
# What cmake --install leaves behind: programs that run and scene data, no sources.
#   install_test.sh CMAKE BUILD_DIR SOURCE_DIR
set -eu
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
"$1" --install "$2" --prefix "$prefix" >/dev/null
"$prefix/bin/obscura" version >/dev/null
# Its neighbours come along as far as they were built, and it finds them where they are now.
for command in bench lesson; do
    if [ -x "$2/bin/obscura-$command" ]; then
        "$prefix/bin/obscura" $command --help | grep -q "^Usage: obscura $command" || {
            echo "obscura $command was not installed"
            exit 1
        }
    fi
done
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
