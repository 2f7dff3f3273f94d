#!/bin/bash
# The script `obscura` against stand-ins for dpkg-query, apt-get, sudo, id, cmake, ninja and ctest, so that every
# path can be walked without installing or building anything.
#   launcher_test.sh SOURCE_DIR
set -u
source_dir=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

expect() {  # expect WHAT TEXT PATTERN
    if [[ $2 != *"$3"* ]]; then
        printf 'FAILED %s: no "%s" in:\n%s\n' "$1" "$3" "$2"
        failures=$((failures + 1))
    fi
}
refuse() {  # refuse WHAT TEXT PATTERN
    if [[ $2 == *"$3"* ]]; then
        printf 'FAILED %s: unexpected "%s" in:\n%s\n' "$1" "$3" "$2"
        failures=$((failures + 1))
    fi
}

tool() {  # tool NAME BODY: a stand-in that also logs its call
    printf '#!/bin/sh\necho "%s $*" >>"%s/calls"\n%s\n' "$1" "$work" "$2" >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}

fresh() {  # a copy of the script in a new folder, everything installed, root, nothing to build
    chmod -R u+w "$work" 2>/dev/null
    rm -rf "$work/house" "$work/bin" "$work/calls" "$work/elsewhere"
    mkdir -p "$work/house" "$work/bin"
    : >"$work/calls"
    cp "$source_dir/obscura" "$source_dir/CMakePresets.json" "$work/house"
    touch -d '1 hour ago' "$work/house/obscura"
    tool dpkg-query 'echo installed'
    tool apt-get 'exit 0'
    tool id 'echo 0'
    tool sudo 'exit 1'
    tool nproc 'echo 2'
    tool sleep 'exec /bin/sleep 0.1'
    tool cmake 'mkdir -p $4/bin; : >$4/build.ninja
        for option in "$@"; do case $option in -D*) echo "${option#-D}" | sed "s/=/:BOOL=/";; esac; done >$4/CMakeCache.txt
        printf "#!/bin/sh\necho \"ran \$*\" in \$PWD; exit 7\n" >$4/bin/obscura; chmod +x $4/bin/obscura'
    tool ninja 'case "$*" in *-n*) echo "no work to do";; esac'
    tool ctest 'echo "ctest $*"; exit 8'
}

run() {  # run ARGS...: output in $out, exit code in $code, calls of tools in $calls
    out=$(cd "$work" && PATH="$work/bin:$PATH" "${launcher:-$work/house/obscura}" "$@" 2>&1 </dev/null)
    code=$?
    calls=$(cat "$work/calls")$'\n'
}

# First run: asks for packages, configures, hands over arguments, folder and exit code.
fresh
run render 'a b.toml' --size=1x1
expect "first run" "$out" "ran render a b.toml --size=1x1 in $work"
expect "first run" "$code" 7
expect "first run" "$calls" "cmake --preset release"
expect "first run" "$calls" "dpkg-query -W -f"
refuse "first run" "$calls" "apt-get"
expect "first run" "$calls" "DOBSCURA_TESTS=OFF -DOBSCURA_BENCH=OFF -DOBSCURA_LESSONS=OFF"
refuse "first run" "$calls" "libgtest-dev"
refuse "first run" "$calls" "libbenchmark-dev"
refuse "first run" "$calls" "libeigen3-dev"
expect "first run" "$calls" "ninja -C $work/house/build/release -n obscura"$'\n'

# Messages that nobody can read end nothing.
for unreadable in '2>/dev/full' '2>&-' '2> >(exit 0)'; do
    fresh
    code=$(cd "$work" && eval "PATH='$work/bin:$PATH' '$work/house/obscura' version $unreadable >/dev/null"; echo $?)
    expect "unreadable messages, $unreadable" "$code" 7
    code=$(cd "$work" && eval "OBSCURA_PRESET=none '$work/house/obscura' version $unreadable >/dev/null"; echo $?)
    expect "unreadable error, $unreadable" "$code" 2
done
fresh
run version

# Second run: asks nobody, says nothing.
: >"$work/calls"
run check
expect "second run" "$out" "ran check in"
refuse "second run" "$out" "obscura:"
refuse "second run" "$calls" "dpkg-query"
refuse "second run" "$calls" "cmake"

# A newer list of packages asks again.
touch -d '1 hour' "$work/house/obscura"
run check
expect "newer script" "$calls" "dpkg-query"

# Through symbolic links, relative and absolute.
fresh
mkdir -p "$work/links"
ln -s ../house/obscura "$work/links/relative"
ln -s "$work/links/relative" "$work/links/absolute"
launcher=$work/links/absolute
run version
unset launcher
expect "symlink" "$out" "ran version in $work"

# Missing packages as root: exactly those are installed.
fresh
tool dpkg-query 'case "$*" in *libtbb-dev|*ninja-build) exit 1;; *libfmt-dev) echo config-files;; *) echo installed;; esac'
run version
expect "install" "$calls" "apt-get update"
expect "install" "$calls" "apt-get install -y --no-install-recommends ninja-build libtbb-dev libfmt-dev"
refuse "install" "$calls" "recommends g++"

# Without the right to install: the line to run, exit 2, and nothing is built.
tool id 'echo 1000'
rm -rf "$work/house/build"
: >"$work/calls"
run version
expect "no right" "$code" 2
expect "no right" "$out" "apt-get update && apt-get install -y --no-install-recommends ninja-build libtbb-dev libfmt-dev"
refuse "no right" "$calls" "apt-get"
refuse "no right" "$calls" "cmake --preset"

# With sudo that needs no password.
tool sudo 'case "$1" in -n) exit 0;; *) exec "$@";; esac'
run version
expect "sudo" "$calls" "sudo apt-get install -y --no-install-recommends ninja-build"
expect "sudo" "$code" 7

# A failing install stops with the line, and is tried again next time.
fresh
tool dpkg-query 'exit 1'
tool apt-get 'exit 100'
run version
expect "failed install" "$code" 2
expect "failed install" "$out" "apt-get update && apt-get install"
: >"$work/calls"
run version
expect "failed install again" "$calls" "dpkg-query"

# test after a picture: the rest of the packages, configured anew, everything is built; arguments go to ctest, whose
# exit code comes back.
fresh
run version
: >"$work/calls"
tool dpkg-query 'case "$*" in *libgtest-dev|*libeigen3-dev) exit 1;; *) echo installed;; esac'
tool ninja 'echo "[1/1] calls for $*"'
run test -R num -L unit
expect "test" "$calls" "apt-get install -y --no-install-recommends libgtest-dev libeigen3-dev"
expect "test" "$calls" "-DOBSCURA_TESTS=ON -DOBSCURA_BENCH=ON -DOBSCURA_LESSONS=ON"
expect "test" "$calls" "ninja -C $work/house/build/release all"
expect "test" "$out" "ctest --test-dir $work/house/build/release -j2 --output-on-failure -LE slow -R num -L unit"
expect "test" "$code" 8
: >"$work/calls"
run test --all -R num
expect "test --all" "$out" "--output-on-failure -R num"
refuse "test --all" "$out" "-LE"
refuse "configured once" "$calls" "cmake --preset"

# Benches and lessons are built when they are asked for, and what was configured before stays.
fresh
run lesson 3
expect "lesson" "$calls" "-DOBSCURA_TESTS=OFF -DOBSCURA_BENCH=OFF -DOBSCURA_LESSONS=ON"
expect "lesson" "$calls" "ninja -C $work/house/build/release -n obscura obscura-lesson"$'\n'
expect "lesson" "$out" "ran lesson 3"
refuse "lesson" "$calls" "libgtest-dev"
: >"$work/calls"
run bench raster
expect "bench" "$calls" "-DOBSCURA_TESTS=OFF -DOBSCURA_BENCH=ON -DOBSCURA_LESSONS=ON"
expect "bench" "$calls" "ninja -C $work/house/build/release -n obscura obscura-bench"$'\n'
expect "bench" "$calls" "libeigen3-dev"
expect "bench" "$out" "ran bench raster"

# A configuration that fails is shown, and begun anew next time.
fresh
tool cmake ': >$4/build.ninja; echo "no such compiler"; exit 1'
run version
expect "failed configuration" "$code" 1
expect "failed configuration" "$out" "no such compiler"
rm -f "$work/house/build/release/build.ninja"
: >"$work/calls"
run version
expect "failed configuration again" "$calls" "cmake --preset release"

# Help: the program's own, then what the launcher adds.
for word in --help -h help; do
    fresh
    tool cmake 'mkdir -p $4/bin; : >$4/build.ninja
        printf "#!/bin/sh\necho \"help of \$*\"\n" >$4/bin/obscura; chmod +x $4/bin/obscura'
    run $word
    expect "$word" "$out" "help of --help"
    expect "$word" "$out" "  test  "
    expect "$word" "$out" "OBSCURA_BUILD_DIR"
    expect "$word" "$code" 0
    run render $word
    expect "render $word" "$out" "help of render $word"
    refuse "render $word" "$out" "  test  "
done

# How long it will take, and how far it is; silence once it is built.
fresh
tool sleep '/bin/sleep 0.1; echo >>'"$work"'/house/slept'
tool ninja 'case "$*" in *-n*) echo "[1/230] a"; echo "[230/230] b";;
    *) echo "[120/230] a"; until [ "$(wc -l <'"$work"'/house/slept)" -ge 2 ]; do /bin/sleep 0.1; done; echo "[230/230] b";; esac'
: >"$work/house/slept"
run version
expect "expected time" "$out" "obscura: building 230 files in $work/house/build/release, about 4 minutes on 2 cores"
expect "progress" "$out" "obscura: 120 of 230 files, 0 min "
refuse "progress" "$out" "[120/230]"
expect "progress" "$out" "ran version"

# Changed lists of files: CMake runs first, so that the files can be counted.
fresh
run version
tool ninja 'case "$*" in *build.ninja*) touch '"$work"'/house/configured;; *-n*)
    if [ -f '"$work"'/house/configured ]; then echo "[1/3] a"; else echo "[0/1] Re-running CMake..."; fi;; esac'
run version
expect "again" "$out" "configuring $work/house/build/release again"
expect "again" "$out" "building 3 files in $work/house/build/release, less than a minute"

# A failing build shows its output and stops.
fresh
tool ninja 'case "$*" in *-n*) echo "[1/2] work";; *) echo "[1/2] Building"; echo "error: wrong semicolon"; echo "  in line 3"; exit 1;; esac'
run version
expect "failed build" "$out" "  in line 3"
expect "failed build" "$out" "error: wrong semicolon"
expect "failed build" "$code" 1
refuse "failed build" "$out" "ran version"

# Other presets, and nonsense.
fresh
OBSCURA_PRESET=debug run version
expect "preset" "$calls" "cmake --preset debug"
expect "preset" "$out" "ran version"
for wrong in ../x rel releese base .; do
    fresh
    OBSCURA_PRESET=$wrong run version
    expect "preset $wrong" "$code" 2
    expect "preset $wrong" "$out" "'$wrong' is not the name of a preset; there are: asan-ubsan clang debug release tsan"
    [ ! -e "$work/house/build" ] || { echo "FAILED preset $wrong: left a folder behind"; failures=$((failures + 1)); }
done

# A source tree that cannot be written. (A file in the folder's place stops root, too.)
fresh
: >"$work/house/build"
run version
expect "read-only" "$code" 2
expect "read-only" "$out" "OBSCURA_BUILD_DIR"
refuse "read-only" "$out" "mkdir"
rm "$work/house/build"
chmod a-w "$work/house"
before=$(ls -A "$work/house")
OBSCURA_BUILD_DIR=$work/elsewhere/deep run version
chmod u+w "$work/house"
expect "build folder" "$out" "ran version in $work"
expect "build folder" "$calls" "cmake --preset release -B $work/elsewhere/deep/release"
expect "build folder" "$calls" "ninja -C $work/elsewhere/deep/release"
[ "$before" = "$(ls -A "$work/house")" ] || { echo "FAILED build folder: wrote beside the script"; failures=$((failures + 1)); }
# Relative to where it is called, as any path.
fresh
OBSCURA_BUILD_DIR=elsewhere run version
expect "relative build folder" "$calls" "-B $work/elsewhere/release"

# Two at once: the second waits for the first.
fresh
tool ninja 'case "$*" in *-n*) echo work;; *) echo start >>"'"$work"'/order"; sleep 0.3; echo end >>"'"$work"'/order";; esac'
rm -f "$work/order"
run version & first=$!
run version & second=$!
wait $first $second
expect "two at once" "$(tr '\n' ' ' <"$work/order")" "start end start end"

[ "$failures" -eq 0 ] && echo "launcher: all paths fine"
exit "$((failures > 0))"
