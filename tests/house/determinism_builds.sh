#!/bin/sh
# One picture for every build: renders every scene of scenes/tests with the given release binary, with a debug
# build and, where clang++ exists, with the clang preset, and compares the files byte by byte.
# Usage: determinism_builds.sh RELEASE_BINARY. Builds take minutes when nothing is cached, so this runs in CI
# and with OBSCURA_SLOW_TESTS=1; otherwise it exits 77, which counts as skipped.
set -eu
if [ "${CI:-}" != true ] && [ "${OBSCURA_SLOW_TESTS:-}" != 1 ]; then
    echo "skipped: builds the program again; set OBSCURA_SLOW_TESTS=1 to run it"
    exit 77
fi
release=$(realpath "$1")
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

scenes=$(ls scenes/tests/*.toml)
[ -n "$scenes" ] || { echo "no scenes in scenes/tests"; exit 1; }

# pictures BINARY NAME: renders every scene into $out/NAME-*.
pictures() {
    for scene in $scenes; do
        stem=$(basename "$scene" .toml)
        "$1" render "$scene" --quiet --output "$out/$2-$stem-####.png" --aov depth,normal,albedo,object,shadow
        "$1" render "$scene" --quiet --output "$out/$2-$stem-####.pfm"
        if ! grep -q '^\[stereo\]' "$scene"; then continue; fi
        "$1" stereo "$scene" --quiet --layout separate --output "$out/$2-$stem-eyes.png" --maps "$out/$2-$stem-map"
    done
}

presets=debug
if command -v clang++ > /dev/null; then
    presets="debug clang"
else
    echo "clang++ is not installed: only g++ builds are compared"
fi

pictures "$release" release
failed=0
for preset in $presets; do
    cmake --preset "$preset" > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
    cmake --build --preset "$preset" --target obscura > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
    pictures "build/$preset/app/obscura" "$preset"
    for expected in "$out"/release-*; do
        actual="$out/$preset-${expected#"$out"/release-}"
        if cmp "$expected" "$actual"; then continue; fi
        echo "the $preset build renders $(basename "$actual") differently"
        failed=1
    done
done
echo "compared with: $presets"
exit $failed
