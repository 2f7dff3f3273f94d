#include "stereo/edit_classes.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

constexpr std::size_t rows_per_block = 16;

PixelClass class_at(const MiddleView& view, int x, int y) {
    return {view.object(x, y), view.material.pixels.empty() ? nothing_seen : view.material(x, y)};
}

void sort_unique(std::vector<PixelClass>& classes) {
    std::sort(classes.begin(), classes.end());
    classes.erase(std::unique(classes.begin(), classes.end()), classes.end());
}

}  // namespace

ClassMap classify(const MiddleView& view, const Image<std::uint8_t>& valid, const Exec& exec) {
    const int width = view.width();
    const auto height = static_cast<std::size_t>(view.height());
    ClassMap map;
    map.of = Image<std::uint32_t>(width, view.height(), no_class);

    // What is seen, per block of rows, then in all. Runs of one class are long: look at changes only.
    std::vector<std::vector<PixelClass>> seen((height + rows_per_block - 1) / rows_per_block);
    parallel_blocks(height, rows_per_block, exec, [&](std::size_t begin, std::size_t end) {
        std::vector<PixelClass>& mine = seen[begin / rows_per_block];
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x)
                if (valid(x, y) != 0 && (mine.empty() || mine.back() != class_at(view, x, y)))
                    mine.push_back(class_at(view, x, y));
        sort_unique(mine);
    });
    for (const std::vector<PixelClass>& block : seen)
        map.classes.insert(map.classes.end(), block.begin(), block.end());
    sort_unique(map.classes);

    parallel_blocks(height, rows_per_block, exec, [&](std::size_t begin, std::size_t end) {
        std::size_t last = 0;
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                if (valid(x, y) == 0) continue;
                const PixelClass wanted = class_at(view, x, y);
                if (map.classes[last] != wanted)
                    last = static_cast<std::size_t>(
                        std::lower_bound(map.classes.begin(), map.classes.end(), wanted) -
                        map.classes.begin());
                map.of(x, y) = static_cast<std::uint32_t>(last);
            }
        }
    });
    return map;
}

std::vector<std::uint8_t> covered_classes(const ClassMap& map, const EditTarget& target) {
    const auto has = [](const std::vector<std::uint32_t>& list, std::uint32_t id) {
        return std::find(list.begin(), list.end(), id) != list.end();
    };
    std::vector<std::uint8_t> covered;
    covered.reserve(map.classes.size());
    for (const PixelClass& c : map.classes)
        covered.push_back(has(target.objects, c.object) || has(target.materials, c.material) ? 1 : 0);
    return covered;
}

double interquartile_mean(std::vector<float>& values) {
    CHECK(!values.empty());
    const auto skip = static_cast<std::ptrdiff_t>(values.size() / 4);
    const auto first = values.begin() + skip, last = values.end() - 1 - skip;
    std::nth_element(values.begin(), first, values.end());
    std::nth_element(first, last, values.end());

    const double step = 1 << 20, bound = 1e5;
    std::int64_t sum = 0;
    for (auto it = first; it != last + 1; ++it)
        sum += std::llround(std::clamp(static_cast<double>(*it), -bound, bound) * step);
    return static_cast<double>(sum) / step / static_cast<double>(last + 1 - first);
}

std::vector<double> centres(const ClassMap& map, const DisparityMap& disparity,
                            const std::vector<std::vector<std::uint32_t>>& groups) {
    // Values of the classes that some group asks for.
    std::vector<std::uint8_t> wanted(map.classes.size(), 0);
    for (const std::vector<std::uint32_t>& group : groups)
        for (const std::uint32_t c : group)
            wanted[c] = 1;
    std::vector<std::vector<float>> values(map.classes.size());
    for (std::size_t i = 0; i < map.of.pixels.size() && !groups.empty(); ++i)
        if (const std::uint32_t c = map.of.pixels[i]; c != no_class && wanted[c] != 0)
            values[c].push_back(disparity.pixels[i]);

    std::vector<double> result;
    std::vector<float> joined;
    for (const std::vector<std::uint32_t>& group : groups) {
        joined.clear();
        for (const std::uint32_t c : group)
            joined.insert(joined.end(), values[c].begin(), values[c].end());
        result.push_back(interquartile_mean(joined));
    }
    return result;
}

}  // namespace obscura
