#!/bin/sh
# One picture for every build: renders every scene of scenes/tests with the given release binary, with a debug
# build and, where clang++ exists, with the clang preset, and compares the files byte by byte.
#   determinism_builds.sh RELEASE_BUILD BUILDS_FOLDER     the other builds are made there
# They compile the program alone: no tests, benches or lessons, and no information for debuggers. Kernels are compiled
# by the same command for Debug as for Release, and are taken from there.
set -eu
release=$(realpath "$1")
builds=$2
cd "$(dirname "$0")/../.."
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

pictures "$release/bin/obscura" release
failed=0
for preset in $presets; do
    build=$builds/$preset
    kernels=
    if [ "$preset" = debug ]; then kernels=$release; fi
    cmake --preset "$preset" -B "$build" -DCMAKE_CXX_FLAGS_DEBUG= -DOBSCURA_FUZZ=OFF "-DOBSCURA_KERNELS_FROM=$kernels" \
        -DOBSCURA_TESTS=OFF -DOBSCURA_BENCH=OFF -DOBSCURA_LESSONS=OFF > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
    cmake --build "$build" --target obscura > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
    pictures "$build/bin/obscura" "$preset"
    for expected in "$out"/release-*; do
        actual="$out/$preset-${expected#"$out"/release-}"
        if cmp "$expected" "$actual"; then continue; fi
        echo "the $preset build renders $(basename "$actual") differently"
        failed=1
    done
done
echo "compared with: $presets"
exit $failed
