#!/bin/bash
# The picture of DESIGN.md, CMake's link graph, what the compiler reaches and what the files include are the same house.
#   room_walls.sh CXX ROOMS_FILE SOURCE_DIR   ROOMS_FILE, from CMake: one line per room, "app/scene|window;window;..."
#   room_walls.sh self-test CXX               builds a small house, breaks each wall and sees it found
set -u -o pipefail
export LC_ALL=C

# A room, and the rooms an arrow leads to; what those reach, it reaches too. Rooms that are not built do not count.
picture() {
    cat <<'END'
core
core/sky         core
scenes           core
raster           core
raster/exact     raster
raster/heights   raster
hierarchy        raster
hierarchy/mh     hierarchy
hierarchy/mmh    hierarchy
hierarchy/dag    hierarchy
hierarchy/facet  hierarchy
hierarchy/codes  hierarchy/dag hierarchy/facet hierarchy/mh hierarchy/mmh
hierarchy/stack  hierarchy
hierarchy/terrain hierarchy raster/heights
filters          hierarchy/codes
optics/field     core
optics/thesis    optics/field
optics           filters optics/thesis
stereo           raster
stereo/solver    stereo
stereo/thesis    stereo/solver
app/models       core
app/elevation    raster/heights
app/scene        app/models app/elevation hierarchy/terrain core/sky optics stereo stereo/thesis scenes
app/glare        app/scene
app/frame        app/glare raster/exact hierarchy/stack
app/pair         app/frame
app/report       app/pair lessons/drawing
app/cli          app/report
lessons/drawing  core
lessons          core/sky optics stereo stereo/thesis scenes raster/exact hierarchy/stack hierarchy/terrain lessons/drawing
bench/embree     core
bench/harness    app/scene
bench/raster     app/frame bench/harness bench/embree
bench/peer_codes raster
bench/shadows    app/frame hierarchy/stack bench/harness bench/embree bench/peer_codes
bench/diffraction bench/harness
bench/stereo     bench/harness
bench/terrain    app/scene bench/harness bench/embree
bench            bench/raster bench/shadows bench/diffraction bench/stereo bench/terrain
END
}

# "ROOM BELOW" for every room and every room it reaches by arrows of the picture, rooms in $1 only.
reach_of_picture() {
    picture | awk -v built="$1" '
        BEGIN { n = split(built, list, " "); for (i = 1; i <= n; ++i) is_built[list[i]] = 1 }
        { rooms[$1] = 1; for (i = 2; i <= NF; ++i) reach[$1, $i] = 1 }
        END {
            for (m in rooms) for (a in rooms) if ((a, m) in reach) for (b in rooms) if ((m, b) in reach) reach[a, b] = 1
            for (a in rooms) for (b in rooms) if ((a, b) in reach && is_built[a] && is_built[b]) print a, b
        }' | sort
}

# The same of the link graph: a room reaches those whose windows it gets.
reach_of_links() {
    awk -F '|' '
        { room[NR] = $1; windows[NR] = $2; name = $1; gsub("/", "_", name); by_name[name] = $1 }
        END {
            for (i = 1; i <= NR; ++i) {
                n = split(windows[i], list, ";")
                for (j = 1; j <= n; ++j) {
                    name = list[j]; sub(/.*\//, "", name)
                    if (name in by_name && by_name[name] != room[i]) print room[i], by_name[name]
                }
            }
        }' "$1" | sort -u
}

# The same of the compiler, for one header of each room. A window shows its whole folder, rooms inside it too: those
# are left to check_includes.
reach_of_compiler() {  # reach_of_compiler CXX ROOMS_FILE
    local snippet
    snippet=$(mktemp)
    cut -d'|' -f1 "$2" | while read -r other; do
        header=$(find "$other" -maxdepth 1 -name '*.h' | sort | head -1)
        [ -z "$header" ] || printf '#if __has_include("%s")\nreaches %s\n#endif\n' "$header" "$other"
    done >"$snippet"
    while IFS='|' read -r room windows; do
        local includes=() list
        IFS=';' read -ra list <<<"$windows"
        for window in "${list[@]}"; do [ -n "$window" ] && includes+=("-I$window"); done
        "$1" -E -P -x c++ "${includes[@]}" "$snippet" | awk -v room="$room" '$1 == "reaches" { print room, $2 }'
    done <"$2" | sort
    rm -f "$snippet"
}

# Every include names a room (by its longest prefix) that the file's own room reaches: ROOM BELOW on stdin.
check_includes() {  # check_includes ROOMS
    local arrows
    arrows=$(cat)
    find . -type f \( -name '*.h' -o -name '*.cpp' \) -not -path './build/*' -not -path './tests/*' \
        -not -path './app/cli/programs/*' -not -path './bench/micro/*' |
        xargs -r grep -HnE '^ *# *include *"' | sed 's|^\./||' |
        awk -v rooms="$1" -v arrows="$arrows" '
            function room_of(path) {
                while (sub(/\/[^\/]*$/, "", path)) if (path in is_room) return path
                return ""
            }
            BEGIN {
                n = split(rooms, list, " "); for (i = 1; i <= n; ++i) is_room[list[i]] = 1
                n = split(arrows, list, "\n"); for (i = 1; i <= n; ++i) allowed[list[i]] = 1
            }
            {
                split($0, at, ":"); header = $0; sub(/^[^"]*"/, "", header); sub(/".*/, "", header)
                from = room_of(at[1]); to = room_of(header)
                if (from != "" && to != "" && from != to && !((from " " to) in allowed))
                    print at[1] ":" at[2] ": includes \"" header "\", and no arrow leads from " from " to " to
            }'
}

check() {  # check CXX ROOMS_FILE, in the source folder; prints findings
    local rooms drawn linked reached
    rooms=$(cut -d'|' -f1 "$2" | tr '\n' ' ')
    [ "$(wc -w <<<"$rooms")" -ge 3 ] || echo "only these rooms were found: $rooms"
    for room in $rooms; do
        picture | awk '{ print $1 }' | grep -qxF "$room" || echo "$room is not in the picture: DESIGN.md, room_walls.sh"
    done
    drawn=$(reach_of_picture "$rooms")
    linked=$(reach_of_links "$2")
    comm -13 <(echo "$drawn") <(echo "$linked") | sed '/./s/\([^ ]*\) \(.*\)/CMake links \1 to \2, and the picture has no arrow/'
    comm -23 <(echo "$drawn") <(echo "$linked") | sed '/./s/\([^ ]*\) \(.*\)/the picture leads from \1 to \2, and CMake does not link them/'
    reached=$(reach_of_compiler "$1" "$2")
    while read -r room other; do
        [ "$room" != "$other" ] || continue
        # Seen through the window of a room that it lies in.
        seen=no
        for outer in $room $(awk -v room="$room" '$1 == room { print $2 }' <<<"$linked"); do
            case $other in "$outer" | "$outer"/*) seen=yes ;; esac
        done
        [ $seen = yes ] || echo "$room can include headers of $other, and CMake does not link them"
    done <<<"$reached"
    for room in $rooms; do
        if ls "$room"/*.h >/dev/null 2>&1; then
            grep -qxF "$room $room" <<<"$reached" || echo "$room does not reach its own headers"
        fi
    done
    check_includes "$rooms" <<<"$linked"
}

self_test() {  # self_test CXX
    local work failures=0
    work=$(mktemp -d)
    house() {  # core, raster, stereo and stereo/thesis, each with a header and its windows
        rm -rf "$work/tree"
        for room in core raster stereo stereo/thesis; do
            name=${room//\//_}
            mkdir -p "$work/tree/$room" "$work/tree/build/$name/$room"
            rm -r "$work/tree/build/$name/$room"
            ln -s "$work/tree/$room" "$work/tree/build/$name/$room"
            echo '#pragma once' >"$work/tree/$room/a.h"
        done
        local w=$work/tree/build
        printf '%s\n' "core|$w/core" "raster|$w/raster;$w/core" "stereo|$w/stereo;$w/raster;$w/core" \
            "stereo/thesis|$w/stereo_thesis;$w/stereo;$w/raster;$w/core" >"$work/rooms"
    }
    try() {  # try WHAT EXPECTED: what is found in the house as it stands
        found=$(cd "$work/tree" && check "$1" "$work/rooms")
        if [ -z "$3" ] && [ -n "$found" ] || [[ $found != *"$3"* ]]; then
            printf 'FAILED %s: expected "%s", found "%s"\n' "$2" "$3" "$found"
            failures=$((failures + 1))
        fi
    }
    house
    echo '#include "stereo/a.h"' >"$work/tree/stereo/thesis/b.cpp"
    echo '#include "core/a.h"' >"$work/tree/raster/b.cpp"
    try "$1" "a house in order" ""
    echo '#include "stereo/thesis/a.h"' >"$work/tree/stereo/b.cpp"
    try "$1" "a room inside another's window" 'stereo/b.cpp:1: includes "stereo/thesis/a.h", and no arrow'
    house
    sed -i "s,^core.*,&;$work/tree/build/raster," "$work/rooms"
    try "$1" "a link upward" "CMake links core to raster"
    house
    sed -i "s,^raster.*,raster|$work/tree/build/raster," "$work/rooms"
    try "$1" "an arrow that is not built" "the picture leads from raster to core"
    house
    sed -i "s,^core.*,&;$work/tree," "$work/rooms"
    try "$1" "the source folder as a window" "core can include headers of raster"
    house
    mkdir "$work/tree/attic"
    echo "attic|$work/tree/build/attic" >>"$work/rooms"
    try "$1" "an unknown room" "attic is not in the picture"
    rm -rf "$work"
    [ "$failures" -eq 0 ]
}

if [ "$1" = self-test ]; then
    self_test "$2"
    exit
fi
rooms_file=$(realpath "$2")
cd "$3" || exit 1
findings=$(check "$1" "$rooms_file")
[ -z "$findings" ] && exit 0
printf '%s\n' "$findings"
exit 1
