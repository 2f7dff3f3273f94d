#!/bin/bash
# A kernel object of a wide instruction set must not export a weak symbol: the linker keeps one copy of those, and
# could hand the wide one to code that runs on a lesser machine (DESIGN.md, "Bit-identical everywhere").
#   kernel_symbols.sh OBJECTS_FILE     lists offenders; the file names one object a line
#   kernel_symbols.sh self-test CXX    compiles an offender and sees it found
set -u -o pipefail

weak_symbols() {  # nm types: W, V weak; u unique; lower-case w, v are references
    nm -C --defined-only "$1" | grep -E '^[0-9a-f]+ [WVu] ' | sed "s|^|$1: |"
}

if [ "$1" = self-test ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    echo '#include <vector>
          void f(std::vector<int>& v, int i) { v.push_back(i); }' >"$work/bad.cpp"
    echo 'namespace { float twice(float x) { return x + x; } } float g(float x) { return twice(x); }' >"$work/good.cpp"
    "$2" -std=c++20 -O0 -c "$work/bad.cpp" -o "$work/bad.o" && "$2" -std=c++20 -O0 -c "$work/good.cpp" -o "$work/good.o" || exit 1
    [ -n "$(weak_symbols "$work/bad.o")" ] || { echo "a weak symbol was not found"; exit 1; }
    [ -z "$(weak_symbols "$work/good.o")" ] || { echo "found a weak symbol where there is none"; exit 1; }
    exit 0
fi

objects=$(grep -E '_kernels_(avx2|avx512bw)' "$1")
if [ -z "$objects" ]; then
    echo "no kernels are built yet"
    exit 77
fi
findings=$(while read -r object; do
    [ -f "$object" ] || echo "$object: missing"
    weak_symbols "$object"
done <<<"$objects")
[ -z "$findings" ] && exit 0
printf '%s\n' "$findings"
exit 1
