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
    if [[ $2 != *$3* ]]; then
        printf 'FAILED %s: no "%s" in:\n%s\n' "$1" "$3" "$2"
        failures=$((failures + 1))
    fi
}
refuse() {  # refuse WHAT TEXT PATTERN
    if [[ $2 == *$3* ]]; then
        printf 'FAILED %s: unexpected "%s" in:\n%s\n' "$1" "$3" "$2"
        failures=$((failures + 1))
    fi
}

tool() {  # tool NAME BODY: a stand-in that also logs its call
    printf '#!/bin/sh\necho "%s $*" >>"%s/calls"\n%s\n' "$1" "$work" "$2" >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}

fresh() {  # a copy of the script in a new folder, everything installed, root, nothing to build
    rm -rf "$work/house" "$work/bin" "$work/calls"
    mkdir -p "$work/house" "$work/bin"
    : >"$work/calls"
    cp "$source_dir/obscura" "$work/house/obscura"
    touch -d '1 hour ago' "$work/house/obscura"
    tool dpkg-query 'echo installed'
    tool apt-get 'exit 0'
    tool id 'echo 0'
    tool sudo 'exit 1'
    tool cmake 'mkdir -p build/$2/app; : >build/$2/build.ninja; printf "#!/bin/sh\necho \"ran \$*\" in \$PWD; exit 7\n" >build/$2/app/obscura; chmod +x build/$2/app/obscura'
    tool ninja 'case "$*" in *-n*) echo "no work to do";; esac'
    tool ctest 'echo "ctest $*"; exit 8'
}

run() {  # run ARGS...: output in $out, exit code in $code, calls of tools in $calls
    out=$(cd "$work" && PATH="$work/bin:$PATH" "${launcher:-$work/house/obscura}" "$@" 2>&1 </dev/null)
    code=$?
    calls=$(cat "$work/calls")
}

# First run: asks for packages, configures, hands over arguments, folder and exit code.
fresh
run render 'a b.toml' --size=1x1
expect "first run" "$out" "ran render a b.toml --size=1x1 in $work"
expect "first run" "$code" 7
expect "first run" "$calls" "cmake --preset release"
expect "first run" "$calls" "dpkg-query -W -f"
refuse "first run" "$calls" "apt-get"

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

# test: everything is built, the rest goes to ctest, whose exit code comes back.
fresh
tool ninja 'echo "calls for $*"'
run test -R num -L unit
expect "test" "$calls" "ninja -C $work/house/build/release all"
expect "test" "$out" "ctest --test-dir $work/house/build/release -j2 --output-on-failure -R num -L unit"
expect "test" "$code" 8

# A failing build shows its output and stops.
fresh
tool ninja 'case "$*" in *-n*) echo "[1/2] work";; *) echo "error: wrong semicolon"; exit 1;; esac'
run version
expect "failed build" "$out" "error: wrong semicolon"
expect "failed build" "$code" 1
refuse "failed build" "$out" "ran version"

# Other presets, and nonsense.
fresh
OBSCURA_PRESET=debug run version
expect "preset" "$calls" "cmake --preset debug"
expect "preset" "$out" "ran version"
OBSCURA_PRESET=../x run version
expect "bad preset" "$code" 2

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
