#!/bin/bash
# A file can include only its own room and those below it: for every pair of rooms, a snippet that is compiled with
# the include folders of the one and includes a header of the other builds exactly where DESIGN.md has an arrow.
#   room_walls.sh CXX ROOMS_FILE SOURCE_DIR     ROOMS_FILE: one line per room, "name|folder;folder;..."
set -u
cxx=$1 rooms_file=$2 source_dir=$3

below() {  # rooms that NAME may include, from the picture in DESIGN.md
    case $1 in
        core) echo ;;
        raster | scenes) echo core ;;
        hierarchy) echo core raster ;;
        filters) echo core raster hierarchy ;;
        optics) echo core raster hierarchy filters ;;
        stereo) echo core raster ;;
        lessons | app | bench) echo core raster hierarchy filters optics stereo scenes lessons app bench ;;
        *) echo "?" ;;
    esac
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0 pairs=0
while IFS='|' read -r room folders; do
    includes=()
    IFS=';' read -ra list <<<"$folders"
    for folder in "${list[@]}"; do [ -n "$folder" ] && includes+=("-I$folder"); done
    allowed=$(below "$room")
    if [ "$allowed" = "?" ]; then
        echo "room $room is not in the picture: tests/room_walls.sh, DESIGN.md"
        failures=$((failures + 1))
    fi
    while IFS='|' read -r other _; do
        header=$(cd "$source_dir" && find "$other" -name '*.h' | sort | head -1)
        [ -n "$header" ] || continue
        echo "#include \"$header\"" >"$work/snippet.cpp"
        # Preprocessing decides whether the header can be reached.
        if "$cxx" -std=c++20 -E "${includes[@]}" "$work/snippet.cpp" >/dev/null 2>"$work/errors"; then
            builds=yes
        elif grep -qE "fatal error: '?$header" "$work/errors"; then
            builds=no
        else
            builds=yes  # the header was found; what it includes from libraries is another matter
        fi
        pairs=$((pairs + 1))
        if [ "$room" = "$other" ]; then
            [ $builds = yes ] || { echo "$room does not reach its own $header"; failures=$((failures + 1)); }
        elif [ $builds = yes ] && [[ " $allowed " != *" $other "* ]]; then
            echo "$room includes $header, and no arrow leads from $room to $other"
            failures=$((failures + 1))
        fi
    done <"$rooms_file"
done <"$rooms_file"
if [ "$pairs" -lt 4 ]; then
    echo "only $pairs pairs of rooms were tried"
    failures=$((failures + 1))
fi
exit "$((failures > 0))"
