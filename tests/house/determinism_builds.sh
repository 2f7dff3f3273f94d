#!/bin/sh
# One picture for every compiler: renders every scene of scenes/tests with the given release binary and with a clang++
# build, and compares the files byte by byte. Debug is looked at by sanitizers.sh, whose build has no optimisation: its
# golden tests ask for the hashes of the same scenes.
#   determinism_builds.sh RELEASE_BUILD BUILDS_FOLDER     the other build is made there
# It compiles the program alone: no tests, benches or lessons. Pictures ask the widest kernels that the machine has:
# those are clang++'s, and narrower ones, which must be there for linking, the release build's.
set -eu
release=$(realpath "$1")
build=$2/clang
cd "$(dirname "$0")/../.."
if ! command -v clang++ >/dev/null; then
    echo "skipped: clang++ is not installed"
    exit 77
fi
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

asked=$("$release/bin/obscura" version | sed -n 's/.*(chosen: \([a-z0-9]*\)).*/\1/p')
case $asked in
    sse2) taken="avx2;avx512bw" ;;
    avx2) taken="sse2;avx512bw" ;;
    avx512bw) taken="sse2;avx2" ;;
    *) echo "which instruction set does $release/bin/obscura choose? '$asked'"; exit 1 ;;
esac
pictures "$release/bin/obscura" release
cmake --preset clang -B "$build" -DOBSCURA_FUZZ=OFF "-DOBSCURA_KERNELS_FROM=$release" "-DOBSCURA_KERNELS_TAKEN=$taken" \
    -DOBSCURA_TESTS=OFF -DOBSCURA_BENCH=OFF -DOBSCURA_LESSONS=OFF > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
cmake --build "$build" --target obscura > "$out/log" 2>&1 || { tail -n 40 "$out/log"; exit 1; }
pictures "$build/bin/obscura" clang
failed=0
for expected in "$out"/release-*; do
    actual="$out/clang-${expected#"$out"/release-}"
    if cmp "$expected" "$actual"; then continue; fi
    echo "the clang++ build renders $(basename "$actual") differently"
    failed=1
done
exit $failed
