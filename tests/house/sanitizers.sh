#!/bin/bash
# The tests of sanitized.txt, built with the preset asan-ubsan: any report fails. By clang++ where it is installed,
# which takes little more than half of g++'s time with these flags.
#   sanitizers.sh SOURCE_DIR BUILD_DIR RELEASE_BUILD     what sanitizers do not watch is linked from RELEASE_BUILD
#   sanitizers.sh SOURCE_DIR BUILD_DIR self-test
# self-test builds nothing of the house: a program that reads past its array must be reported with the preset's flags.
set -u -o pipefail
cd "$1" || exit 1
mkdir -p "$2"

# Debian has the sanitizers' libraries in a package of their own.
echo 'int main() {}' >"$2/empty.cpp"
compiler=c++
if clang++ -fsanitize=address,undefined -o "$2/empty" "$2/empty.cpp" 2>/dev/null; then compiler=clang++; fi
build=$2/$compiler
mkdir -p "$build"

if [ "$3" = self-test ]; then
    flags=$(sed -n 's/.*"OBSCURA_SANITIZE": "\(address[a-z,]*\)".*/\1/p' CMakePresets.json)
    echo 'int main(int count, char**) { int* a = new int[1]; int past = a[count]; delete[] a; return past == 7 ? 1 : 0; }' >"$build/past.cpp"
    "$compiler" "-fsanitize=$flags" -o "$build/past" "$build/past.cpp" || exit 1
    if "$build/past" >/dev/null 2>&1; then
        echo "reading past an array was not reported"
        exit 1
    fi
    exit 0
fi

# Line numbers are enough for a report. Warnings are for the other builds: with these flags g++ 12 gives false ones.
cmake --preset asan-ubsan -B "$build" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS_DEBUG=-g1 \
    "-DOBSCURA_KERNELS_FROM=$3" "-DOBSCURA_KERNELS_TAKEN=avx2;avx512bw" -DOBSCURA_PEERS=OFF -DOBSCURA_WERROR=OFF >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
programs=$(grep -E '^[a-z]' tests/house/sanitized.txt | awk '{ print $1 }')
cmake --build "$build" --target $programs >"$build/log" 2>&1 || { tail -n 60 "$build/log"; exit 1; }

# Two programs at a time; each leaves what it said in a file of its own when it fails.
run() {  # run PROGRAM FILTER
    local found log="$build/$1.log"
    found=$(find "$build/tests" -name "$1" -type f)
    if ! (cd "$build" && UBSAN_OPTIONS=print_stacktrace=1 timeout 900 "$found" --gtest_brief=1 "--gtest_filter=$2") >"$log" 2>&1; then
        echo "FAILED: $1 --gtest_filter=$2"
        cat "$log"
        return 1
    elif ! grep -qE '^\[==========\] [1-9][0-9]* tests? ' "$log"; then
        echo "FAILED: $1 --gtest_filter=$2 ran no test"
        return 1
    fi
}
export build
export -f run
grep -E '^[a-z]' tests/house/sanitized.txt | xargs -P 2 -L 1 bash -c 'run "$0" "$1"'
