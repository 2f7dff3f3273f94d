#!/bin/bash
# What the architecture promises about the source itself. Each check prints its findings, one a line, and
# nothing when all is well.
#
#   house_checks.sh CHECK SOURCE_DIR     exit 0 clean, 1 findings, 77 cannot be checked here
#   house_checks.sh self-test            plants one violation of every rule in a small tree and sees it found
set -u -o pipefail
export LC_ALL=C

rooms="core raster hierarchy filters optics stereo app lessons bench tests scenes fuzz"

sources() {  # C++ files of the rooms in the current folder
    local present=()
    for room in $rooms; do [ -d "$room" ] && present+=("$room"); done
    find "${present[@]}" -type f \( -name '*.h' -o -name '*.cpp' \) | sort
}

# grep over source lines without // comments: FILE:LINE:TEXT
grep_code() {  # grep_code PATTERN FILES...
    local pattern=$1
    shift
    [ $# -gt 0 ] || return 0
    awk '{ line = $0; sub(/\/\/.*/, "", line); print FILENAME ":" FNR ":" line }' "$@" | grep -E "^[^:]*:[0-9]+:.*($pattern)"
}

# One file knows each library; everyone else asks it.
check_doors() {
    door() {  # door NAME INCLUDE ALLOWED_FILES
        sources | grep -vE "^($3)$" | xargs -r grep -nE "^ *# *include *[<\"]($2)" | sed "s/$/    ($1 has another door)/"
    }
    door TBB '(one)?tbb/|oneapi/' 'core/parallel\.cpp'
    door xsimd 'xsimd/' 'core/simd(_[a-z]+)?\.h'
    door stb 'stb/|stb_' 'core/image_io\.cpp'
    door toml++ 'toml\+\+/|toml\.hpp' 'app/scene/toml_parse\.cpp'
    door tinyobjloader 'tiny_obj' 'app/models/mtl_text\.cpp|tests/fuzz/obj_peer\.cpp'
    door nlohmann-json 'nlohmann/' 'app/models/json_place\.h'
    door CLI11 'CLI/|CLI11' 'app/cli/flags\.cpp'
    door libtiff 'tiff' 'app/elevation/read_geotiff\.cpp|tests/elevation/geotiff_test\.cpp'
    door GoogleTest 'g(test|mock)/' 'tests/.*'
    door 'Google Benchmark' 'benchmark/' 'bench/.*'
    door 'Embree, OSMesa' 'embree|GL/' 'bench/.*'
    door FFTW 'fftw3' 'bench/diffraction/peer_fftw\.cpp'
    door CHOLMOD 'cholmod' 'bench/stereo/peer_cholmod\.cpp'
    door Eigen 'Eigen/' 'bench/stereo/peer_eigen\.cpp|tests/stereo/truth_test\.cpp'
    door 'wide intrinsics' '(imm|avx[a-z0-9_]*|x86)intrin\.h' 'core/simd(_[a-z]+)?\.h|bench/.*'
}

# Rooms are entered by their name, not through the wall.
check_includes() {
    sources | xargs -r grep -nE '^ *# *include *"([^"]*\.\./|/)'
    # Within a room, too, a header is named with its room; tests alone may name a neighbour plainly.
    sources | grep -v '^tests/' | xargs -r grep -nE '^ *# *include *"[^/"]+"'
}

# libm's bits vary with the CPU: num has its own. Exact functions (sqrt, floor, fabs, fmod, ...) are fine.
check_libm() {
    local f='(sin|cos|tan|sincos|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma)'
    local files
    mapfile -t files < <(sources | grep -vE '^(tests|bench)/|^core/num\.(h|cpp)$')
    [ ${#files[@]} -gt 0 ] || return 0
    # std::f, ::f, ff (the float form); a plain f( too where nothing of ours can be meant.
    grep_code "(std::|[^A-Za-z0-9_]::)${f}[fl]? *\(|(^|[^A-Za-z0-9_:.>])${f}[fl] *\(|[=(+*/,-] *${f} *\(" "${files[@]}"
    grep -nE "^ *using (namespace std|std::$f);" "${files[@]}"
}

check_files() {
    sources | xargs -r awk 'FNR == 401 { print FILENAME ": more than 400 lines" }'
    sources | grep -E '(^|/)(utils|util|helpers|helper|common|misc)\.[a-z]+$' | sed 's/$/: the name says nothing/'
    sources | xargs -r grep -nE '\b(TODO|FIXME|XXX|HACK)\b'
    sources | grep '\.h$' | xargs -r grep -L '^#pragma once' | sed 's/$/: no #pragma once/'
}

# All rooms share a namespace, so a type's name has one meaning in it: of two with the same name the linker keeps one's
# functions (constructors, vectors of them) for both and says nothing. Unnamed namespaces hide theirs.
check_names() {
    local files
    mapfile -t files < <(sources)
    [ ${#files[@]} -gt 0 ] || return 0
    awk '
        FNR == 1 { depth = hidden = 0 }
        /^namespace / { space[++depth] = $2; if ($2 == "{") ++hidden; next }
        /^}.*\/\/ namespace/ && depth > 0 { if (space[depth] == "{") --hidden; --depth; next }
        !hidden && /^(struct|class|enum class) / && (/\{/ || !/;$/) {
            line = $0
            sub(/^(enum )?(struct|class) +(alignas\([^)]*\) +)?/, "", line)
            if (line ~ /^[A-Za-z0-9_]+::/) next  # of a class that is declared elsewhere
            match(line, /^[A-Za-z0-9_<>, ]*[A-Za-z0-9_>]/)
            name = substr(line, 1, RLENGTH); sub(/ final$/, "", name)
            for (i = depth; i > 0; --i) name = space[i] "::" name
            if (name in place && place[name] != FILENAME)
                print FILENAME ":" FNR ": there is another " name " in " place[name]
            else place[name] = FILENAME
        }' "${files[@]}"
}

# Every relative link and every file that a page names is there, and every one that a comment names with its folder: beside the page or below it, or named
# from the top. A file is a name with an ending of sources or pages; data and pictures only with their folder. Words in
# capitals stand for something else (NAME.txt), and what a build or the reader makes is not looked for. And links lead
# from the front page to every page.
check_links() {
    local pages place name
    sources | xargs -r grep -HnoE '// .*[a-z_]+/[a-z_]+\.(h|cpp)\b' |
        sed -E 's#^([^:]*:[0-9]+):.*[^a-z_/.]([a-z_/]+/[a-z_]+\.(h|cpp))$#\1 \2#' |
        while read -r place name; do [ -e "$name" ] || echo "$place: there is no $name"; done
    mapfile -t pages < <(find . -name "*.md" -not -path "./build/*" -not -path "./.git/*" -not -path "./bench/results/*" | sort)
    [ ${#pages[@]} -gt 0 ] || return 0
    find . -not -path './build/*' -not -path './.git/*' | awk '
        function tidy(path) {
            gsub(/\/\.\//, "/", path)
            sub(/\/$/, "", path)
            while (sub(/[^\/]+\/\.\.\//, "", path)) {}
            return path
        }
        function is_there(name, folder,   i, n, list, base) {
            if (tidy(folder name) in present || tidy("./" name) in present) return 1
            base = name; sub(/.*\//, "", base)
            n = split(with_base[base], list, "\n")
            for (i = 1; i <= n; ++i)
                if (index(list[i], folder) == 1 && substr("/" list[i], length(list[i]) - length(name) + 1) == "/" name) return 1
            return 0
        }
        FNR == NR {
            present[$0] = 1; base = $0; sub(/.*\//, "", base); with_base[base] = with_base[base] "\n" $0
            next
        }
        {
            page = FILENAME; sub(/^\.\//, "", page); folder = FILENAME; sub(/[^\/]*$/, "", folder)
            line = $0
            while (match(line, /\]\([^)]*\)/)) {
                link = substr(line, RSTART + 2, RLENGTH - 3); line = substr(line, RSTART + RLENGTH)
                sub(/#.*/, "", link)
                if (link == "" || link ~ /^[a-z]+:/) continue
                if (tidy(folder link) in present) links[FILENAME] = links[FILENAME] "\n" tidy(folder link)
                else print page ":" FNR ": the link " link " leads nowhere"
            }
            line = $0
            gsub(/\]\([^)]*\)/, "", line); gsub(/\/\.cpp/, "", line)
            while (match(line, /[A-Za-z0-9_.\/*{},#~$<>-]*[A-Za-z0-9_]\.(h|cpp|md|sh|cmake|txt|toml|obj|png|svg|csv)/)) {
                name = substr(line, RSTART, RLENGTH); line = substr(line, RSTART + RLENGTH)
                if (line ~ /^[A-Za-z0-9_\/*-]/ || name ~ /[*{},#~$<>]/ || name ~ /^(\/|\.\.\/|build\/|out\/)/) continue
                placeholder = name; gsub(/README|LICENSE|CMakeLists/, "", placeholder)
                if (placeholder ~ /[A-Z]/ || (name ~ /\.(txt|toml|obj|png|svg|csv)$/ && name !~ /[a-z]\//)) continue
                sub(/^\.\//, "", name)
                if (!is_there(name, folder)) print page ":" FNR ": there is no " name
            }
        }
        END {
            if (!("./README.md" in present)) exit
            reached["./README.md"] = 1; queue[1] = "./README.md"
            for (next_page = last = 1; next_page <= last; ++next_page) {
                n = split(links[queue[next_page]], list, "\n")
                for (i = 2; i <= n; ++i)
                    if (!(list[i] in reached)) { reached[list[i]] = 1; queue[++last] = list[i] }
            }
            for (page in present)
                if (page ~ /\.md$/ && !(page in reached)) print substr(page, 3) ": no link leads here from README.md"
        }' - "${pages[@]}"
}

check_format() {
    local version
    version=$(clang-format --version 2>/dev/null | grep -oE '[0-9]+\.' | head -1)
    if [ "$version" != 14. ]; then
        echo "SKIPPED: clang-format 14 is not installed" >&2
        return 77
    fi
    sources | xargs -r clang-format --dry-run -Werror 2>&1 | grep -E 'error|warning'
}

run_check() {  # run_check NAME DIR
    local findings status
    findings=$(cd "$2" && "check_$1")
    status=$?
    [ "$status" -ne 77 ] || return 77
    [ -n "$findings" ] || return 0
    printf '%s\n' "$findings"
    return 1
}

self_test() {
    local work failures=0
    work=$(mktemp -d)
    plant() {  # plant CHECK FILE TEXT EXPECTED(clean|found)
        rm -rf "$work/tree"
        mkdir -p "$work/tree/$(dirname "$2")"
        cp .clang-format "$work/tree" 2>/dev/null
        printf '%b' "$3" >"$work/tree/$2"
        [ -z "${twin-}" ] || printf '%b' "$twin" >"$work/tree/$(dirname "$2")/twin.h"
        [ -z "${front_page-}" ] || printf '%b' "$front_page" >"$work/tree/README.md"
        run_check "$1" "$work/tree" >"$work/out" 2>/dev/null
        local status=$?
        [ "$status" -ne 77 ] || return 0
        case $4:$status in
            clean:0 | found:1) ;;
            *)
                printf 'FAILED: %s should be %s for %s: %s\n%s\n' "$1" "$4" "$2" "$3" "$(cat "$work/out")"
                failures=$((failures + 1))
                ;;
        esac
    }
    plant doors raster/a.cpp '#include <tbb/parallel_for.h>\n' found
    plant doors core/parallel.cpp '#include <tbb/parallel_for.h>\n' clean
    plant doors filters/a.cpp '#include <xsimd/xsimd.hpp>\n' found
    plant doors core/simd_lanes.h '#include <xsimd/xsimd.hpp>\n' clean
    plant doors core/a.h '#include <xsimd/xsimd.hpp>\n' found
    plant doors app/png.cpp '#include "stb_image.h"\n' found
    plant doors app/scene/scene_file.cpp '#include <toml++/toml.h>\n' found
    plant doors app/scene/toml_parse.cpp '#include <toml++/toml.h>\n' clean
    plant doors core/mesh.cpp '#include <tiny_obj_loader.h>\n' found
    plant doors tests/fuzz/obj_dialect.cpp '#include <tiny_obj_loader.h>\n' found
    plant doors tests/fuzz/obj_peer.cpp '#include <tiny_obj_loader.h>\n' clean
    plant doors app/models/mtl_text.cpp '#include <tiny_obj_loader.h>\n' clean
    plant doors app/cli/flags.h '#include <CLI/CLI.hpp>\n' found
    plant doors app/cli/render_command.cpp '#include <CLI/CLI.hpp>\n' found
    plant doors app/elevation/elevation.cpp '#include <tiffio.h>\n' found
    plant doors app/elevation/read_geotiff.cpp '#include <tiffio.h>\n' clean
    plant doors app/cli/flags.cpp '#include <CLI/CLI.hpp>\n' clean
    plant doors bench/stereo/peers.cpp '#include <cholmod.h>\n' found
    plant doors core/a.cpp '#include <immintrin.h>\n' found
    plant includes raster/a.cpp '#include "../core/vec.h"\n' found
    plant includes raster/a.cpp '#include "vec.h"\n' found
    plant includes raster/a.cpp '#include "core/vec.h"\n#include <vector>\n' clean
    plant libm raster/a.cpp 'float f(float x) { return std::sin(x); }\n' found
    plant libm raster/a.cpp 'float f(float x) { return sinf(x); }\n' found
    plant libm raster/a.cpp 'float f(float x) { return 2 * pow(x, 3); }\n' found
    plant libm raster/a.cpp 'double y = std::hypot(a, b);\n' found
    plant libm raster/a.cpp 'double y = num::sin(x) + num::pow(x, 2); // std::sin(x)\n' clean
    plant libm raster/a.cpp 'double y = num::sin(x) + std::sin(x);\n' found
    plant libm raster/a.cpp 'double y = std::sqrt(x) + std::floor(x);\n' clean
    plant libm app/a.cpp 'using std::pow;\n' found
    plant libm app/a.cpp 'using namespace std::chrono;\n' clean
    plant libm tests/a.cpp 'double y = std::sin(x);\n' clean
    plant files core/utils.h '#pragma once\n' found
    plant files core/a.h '\n' found
    plant files core/a.cpp "$(printf 'x\\n%.0s' {1..401})" found
    plant files core/a.cpp '// TODO later\n' found
    plant files core/a.h '#pragma once\nint f();\n' clean
    twin='namespace obscura {\nstruct A {\n};\n}  // namespace obscura\n'
    plant names core/a.h 'namespace obscura {\nenum class A { b, c };\n}  // namespace obscura\n' found
    plant names core/a.cpp 'namespace obscura {\nstruct alignas(64) A : B {\n};\n}  // namespace obscura\n' found
    plant names core/a.cpp 'namespace obscura {\nstruct A;\nnamespace {\nstruct A {\n};\n}  // namespace\n}' clean
    plant names core/a.cpp 'namespace obscura::test {\nclass A {};\n}  // namespace obscura::test\n' clean
    twin=
    plant links core/README.md 'See [there](b.md).\n' found
    plant links core/README.md 'See [here](README.md#top) and [top](https://a.b/c.md).\n' clean
    plant links core/README.md 'Read `gone.h` first.\n' found
    plant links core/limits.md '| `core/gone.cpp` | it |\n' found
    plant links core/README.md '`README.md`, core/README.md, NAME.txt, `*_ref.cpp`, picture.png, build/x.txt\n' clean
    plant links core/README.md './obscura render scenes/gone.toml\n' found
    plant links core/a.h '// As core/gone.h says.\n' found
    plant links core/a.h '// As core/a.h says, and a.h.\n' clean
    local front_page='Read [core](core/README.md).\n'
    plant links core/README.md 'Reached.\n' clean
    front_page='No link.\n'
    plant links core/README.md 'See [it](README.md).\n' found
    front_page=
    plant format core/a.cpp 'int  f( ) ;\n' found
    plant format core/a.cpp 'int f();\n' clean
    rm -rf "$work"
    [ "$failures" -eq 0 ]
}

case $1 in
    self-test) self_test ;;
    *) run_check "$1" "$2" ;;
esac
