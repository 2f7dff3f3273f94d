#!/bin/bash
# One source file after the other, without the precompiled headers: what changed lately, however long it takes; then
# what includes it, then the others, each in an order that every commit shuffles anew, until time is up.
#   file_by_file.sh tidy BUILD_DIR SOURCE_DIR SECONDS      clang-tidy 14 with the rules of .clang-tidy: all rooms,
#       lessons and bench too (fewer checks), but no tests and no kernels
#   file_by_file.sh includes BUILD_DIR SOURCE_DIR SECONDS  every file compiles with the includes it names itself. What
#       clang-tidy has found fine since the sources are as they are has been compiled so and is not looked at again.
#   file_by_file.sh self-test CXX
# BUILD_DIR is made for it: a release build that is configured with OBSCURA_PRECOMPILE=OFF and never built. Changed
# is what differs from the last commit or was in a commit of the six hours before it, and the source beside a header
# that did. What is left out is named. OBSCURA_ALL_FILES=1: every file, however long it takes.
set -u -o pipefail
export LC_ALL=C
self=$(realpath "$0")

# One file, in a process of its own: FILE, DIRECTORY and COMMAND of the compiler, tabs between.
look_at() {  # look_at MODE BUILD_DIR DEADLINE LINE
    IFS=$'\t' read -r file directory command <<<"$4"
    if [ "$3" -gt 0 ] && [ "$(date +%s)" -ge "$3" ]; then
        echo "left out: $file"
        return 0
    fi
    local status=0
    if [ "$1" = tidy ]; then
        # Benches and lessons without the analyzer, which takes most of the time; lessons may lay out a page by whole
        # divisions, round colours and append points one by one.
        local checks=
        case $file in
            */bench/*) checks='-clang-analyzer-*' ;;
            */lessons/*)
                checks='-clang-analyzer-*,-bugprone-integer-division,-bugprone-incorrect-roundings'
                checks+=,-performance-inefficient-vector-operation
                ;;
        esac
        clang-tidy -p "$2" --quiet "--checks=$checks" --extra-arg=-Wno-unknown-warning-option "$file" 2>/dev/null || status=$?
    else
        parse "$2" "$file" "$directory" "$command" 2>&1 || status=$?
    fi
    if [ $status -eq 0 ]; then echo "fine: $file"; else echo "failed: $file"; fi
}

# The compiler's command without the cache, which has nothing to keep here, and without what it makes of the file.
bare() {
    sed -E 's|^.*/ccache ||; s| -o [^ ]+ -c [^ ]+$||; s| -O[13] | -O0 |g' <<<"$1"
}

# Tests begin with GoogleTest, which is half of what they parse: those that name it first are given it parsed.
is_test() {
    [ "$(grep -m 1 '^#include' "$1")" = '#include <gtest/gtest.h>' ]
}
parse() {  # parse BUILD_DIR FILE DIRECTORY COMMAND
    local first=
    if [ -e "$1/gtest_first.h.gch" ] && is_test "$2"; then first="-include $1/gtest_first.h"; fi
    cd "$3" && eval "$(bare "$4") $first -fsyntax-only $2"
}
parse_gtest() {  # parse_gtest BUILD_DIR FILES
    local file directory command
    while IFS=$'\t' read -r file directory command; do
        is_test "$file" || continue
        echo '#include <gtest/gtest.h>' >"$1/gtest_first.h"
        (cd "$directory" && eval "$(bare "$command") -x c++-header -o $1/gtest_first.h.gch $1/gtest_first.h") && return
        rm -f "$1/gtest_first.h.gch"
        return
    done <"$2"
}

# What all sources are, in a word.
state_of_sources() {
    find . -path ./build -prune -o \( -name '*.h' -o -name '*.cpp' \) -type f -print0 | sort -z | xargs -0 cat | sha1sum
}

# FILE, DIRECTORY, COMMAND of every file once; kernels with their narrowest instruction set.
commands() {
    awk -v OFS='\t' '
        function value(line) { sub(/^[^:]*: "/, "", line); sub(/",?$/, "", line); return line }
        /^ *"directory":/ { directory = value($0) }
        /^ *"command":/ { command = value($0); gsub(/\\"/, "\"", command); gsub(/\\\\/, "\\", command) }
        /^ *"file":/ {
            file = value($0)
            if (command !~ /_kernels_avx/ && file !~ /\/parsed_for_/ && !(file in seen)) print file, directory, command
            seen[file] = 1
        }' "$1/compile_commands.json"
}

# Headers and sources that changed.
changed_files() {
    local last
    last=$(git log -1 --format=%ct 2>/dev/null) || { echo "no history: nothing counts as changed" >&2; return 0; }
    (git log --since="$((last - 21600))" --name-only --format= && git diff --name-only HEAD) |
        grep -E '\.(h|cpp)$' | sort -u
}

# Sources that include one of the headers on standard input.
includers() {
    grep '\.h$' | sed 's/.*/"&"/' | grep -rlF --include='*.cpp' -f - core raster hierarchy filters optics \
        stereo scenes app lessons bench tests 2>/dev/null
}

# Of the commands on standard input, those of the files that FILE names.
of_files() {  # of_files FILE
    awk -F '\t' 'FILENAME != "-" { is[$1] = 1; next } $1 in is' "$1" -
}
not_of_files() {  # not_of_files FILE
    awk -F '\t' 'FILENAME != "-" { is[$1] = 1; next } !($1 in is)' "$1" -
}
shuffled() {
    shuf --random-source=<(yes "$(git rev-parse HEAD 2>/dev/null)")
}

run() {  # run MODE BUILD_DIR SOURCE_DIR SECONDS
    local work deadline
    work=$(mktemp -d)
    cd "$3" || exit 1
    commands "$2" >"$work/all"
    [ -s "$work/all" ] || { echo "no commands in $2/compile_commands.json"; return 1; }
    changed_files >"$work/changed"
    sed "s|^|$PWD/|; s|\.h$|.cpp|" "$work/changed" | sort -u >"$work/own"
    includers <"$work/changed" | sed "s|^|$PWD/|" >"$work/including"
    of_files "$work/own" <"$work/all" >"$work/first"
    not_of_files "$work/own" <"$work/all" >"$work/other"
    of_files "$work/including" <"$work/other" | shuffled >"$work/then"
    not_of_files "$work/including" <"$work/other" | shuffled >>"$work/then"
    : >"$work/tidied"
    if [ "$1" = tidy ]; then
        # Not kernels, which are built once per instruction set; not image_io.cpp, which holds all of stb; not tests,
        # which are mostly macros of GoogleTest.
        chosen() { grep -vE '_kernel\.cpp'$'\t''|/image_io\.cpp'$'\t'"|^$PWD/tests/"; }
    else
        if [ "$(head -n 1 "$2/tidied" 2>/dev/null)" = "$(state_of_sources)" ]; then cp "$2/tidied" "$work/tidied"; fi
        chosen() { not_of_files "$work/tidied"; }
    fi
    chosen <"$work/first" >"$work/always"
    chosen <"$work/then" >"$work/timed"
    if [ "$1" = includes ]; then parse_gtest "$2" <(cat "$work/always" "$work/timed"); fi
    deadline=$(($(date +%s) + $4))
    [ -z "${OBSCURA_ALL_FILES-}" ] || deadline=0
    each() { xargs -r -d '\n' -P 2 -n 1 bash "$self" look-at "$1" "$2" "$3" <"$4"; }
    (each "$1" "$2" 0 "$work/always"; each "$1" "$2" "$deadline" "$work/timed") >"$work/out"
    if [ "$1" = tidy ]; then { state_of_sources; sed -n 's/^fine: //p' "$work/out"; } >"$2/tidied"; fi
    grep -vE '^(fine|left out): ' "$work/out"
    echo "$(grep -c '^fine: ' "$work/out") files are fine, $(grep -c '^failed: ' "$work/out") are not;" \
        "$(wc -l <"$work/first") of $(wc -l <"$work/all") have changed," \
        "$(grep -c / "$work/tidied") were looked at by clang-tidy"
    grep '^left out: ' "$work/out" && echo "(left out: no time for them in $4 seconds)"
    local failed=0
    if grep -q '^failed: ' "$work/out"; then failed=1; fi
    if [ "$(grep -cE '^(fine|failed|left out): ' "$work/out")" -ne "$(cat "$work/always" "$work/timed" | wc -l)" ]; then
        echo "not every file was looked at"
        failed=1
    fi
    rm -rf "$work"
    return $failed
}

# Files with and without all their includes, in a small house without history, and with one that changed.
self_test() {
    unset OBSCURA_ALL_FILES
    local work failures=0
    work=$(mktemp -d)
    mkdir -p "$work/core" "$work/include/gtest"
    echo '#include <string>' >"$work/include/gtest/gtest.h"
    echo '#include <vector>
          std::vector<int> f() { return {}; }' >"$work/core/good.cpp"
    echo 'std::vector<int> f() { return {}; }' >"$work/core/bad.cpp"
    echo '#include <gtest/gtest.h>
          std::string f() { return {}; }' >"$work/core/good_test.cpp"
    echo '#include <gtest/gtest.h>
          std::vector<std::string> f() { return {}; }' >"$work/core/bad_test.cpp"
    local between='['
    for file in good bad good_test bad_test; do
        printf '%s{\n  "directory": "%s",\n  "command": "%s -o a.o -c %s",\n  "file": "%s"\n}\n' \
            "$between" "$work" "$1 -I$work/include -O3" "$work/core/$file.cpp" "$work/core/$file.cpp"
        between=,
    done >"$work/compile_commands.json"
    echo ']' >>"$work/compile_commands.json"
    expect() {  # expect SECONDS PATTERN STATUS MODE
        out=$(run "$4" "$work" "$work" "$1" 2>&1)
        status=$?
        if [ "$status" -eq "$3" ] && grep -q "$2" <<<"$out"; then return; fi
        printf 'FAILED: expected "%s" and %s of %s, got %s and:\n%s\n' "$2" "$3" "$4" "$status" "$out"
        failures=1
    }
    expect 60 "failed: $work/core/bad.cpp" 1 includes
    expect 60 '2 files are fine, 2 are not' 1 includes
    expect 0 "left out: $work/core/good.cpp" 0 includes
    if clang-tidy --version >/dev/null 2>&1; then
        expect 60 "failed: $work/core/bad.cpp" 1 tidy
        # Both failed ones again, and the fine ones no more.
        expect 60 "failed: $work/core/bad_test.cpp" 1 includes
        expect 60 '0 files are fine, 2 are not; .* 2 were looked at' 1 includes
        echo >>"$work/core/good.cpp"
        expect 60 '2 files are fine, 2 are not; .* 0 were looked at' 1 includes
    fi
    # What changed is looked at even when there is no time, and the rest is not.
    (cd "$work" && git init -q && git add core/bad.cpp && git -c user.name=a -c user.email=a@b commit -qm a)
    expect 0 "failed: $work/core/bad.cpp" 1 includes
    expect 0 "left out: $work/core/good.cpp" 1 includes
    rm -rf "$work"
    return $failures
}

case $1 in
    look-at) look_at "${@:2}" ;;
    self-test) self_test "$2" ;;
    *)
        if [ "$1" = tidy ] && ! clang-tidy --version 2>/dev/null | grep -q 'version 14\.'; then
            echo "skipped: clang-tidy 14 is not installed"
            exit 77
        fi
        cmake --preset release -S "$3" -B "$2" -DOBSCURA_PRECOMPILE=OFF >"$2.log" 2>&1 || { cat "$2.log"; exit 1; }
        run "$@"
        ;;
esac
