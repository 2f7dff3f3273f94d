#!/bin/bash
# Every line of tests/slow.txt and of tests/house/sanitized.txt still means a test.
#   slow_names.sh SOURCE_DIR PROGRAMS_FILE     PROGRAMS_FILE, from CMake: the path of one test program a line
set -u
status=0
while read -r program filter _; do
    path=$(grep "/$program\$" "$2")
    if [ -z "$path" ]; then
        echo "there is no $program"
        status=1
        continue
    fi
    # Each pattern by itself, those that leave out too.
    while read -r pattern; do
        "$path" --gtest_list_tests "--gtest_filter=$pattern" | grep -q '^  ' && continue
        echo "$program has no test $pattern"
        status=1
    done < <(tr ':' '\n' <<<"${filter#-}")
done < <(grep -hE '^[a-z]' "$1/tests/slow.txt" "$1/tests/house/sanitized.txt")
exit $status
