#!/bin/bash
# Every line of tests/slow.txt and of tests/house/sanitized.txt still means a test, and ./obscura test leaves the slow
# ones out.
#   slow_names.sh SOURCE_DIR PROGRAMS_FILE CTEST BUILD_DIR
# PROGRAMS_FILE, from CMake: the path of one test program a line.
set -u
status=0
fast=$(sed -n 's/^ *fast="\(-LE .*\)"$/\1/p' "$1/obscura")
for test in House.sanitizers FrameMemory.EstimatesAreNearWhatIsReallyTaken; do
    "$3" --test-dir "$4" -N -R "^$test\$" | grep -q 'Total Tests: 1' || { echo "there is no $test"; status=1; }
    "$3" --test-dir "$4" -N -R "^$test\$" $fast | grep -q 'Total Tests: 0' ||
        { echo "ctest $fast runs the slow $test"; status=1; }
done
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
    done < <(tr -s ':-' '\n' <<<"${filter#-}")
done < <(grep -hE '^[a-z]' "$1/tests/slow.txt" "$1/tests/house/sanitized.txt")
exit $status
