#include "app/glare/pupil_classes.h"

#include <cmath>

namespace obscura {
namespace {

ClassKey key_of(const SeenShare& v, double steps) {
    const auto step = [&](double value, double scale) {
        return static_cast<int>(std::floor(value * scale * steps + 0.5));
    };
    return {step(v.share, 1), step(v.x, 2), step(v.y, 2)};
}

}  // namespace

Image<float> survey_of(const Image<float>& mask) {
    Image<float> coarse(survey_texels, survey_texels), count(survey_texels, survey_texels);
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const int i = x * survey_texels / mask.width, j = y * survey_texels / mask.height;
            coarse(i, j) += mask(x, y);
            count(i, j) += 1;
        }
    }
    for (std::size_t i = 0; i < coarse.pixels.size(); ++i)
        coarse.pixels[i] = count.pixels[i] > 0 ? coarse.pixels[i] / count.pixels[i] : 0.0f;
    return coarse;
}

SeenShare seen_share(const Image<std::uint8_t>& open, const Image<float>& survey) {
    double all = 0, left = 0, x = 0, y = 0;
    for (int row = 0; row < open.height; ++row) {
        for (int column = 0; column < open.width; ++column) {
            const auto light = static_cast<double>(survey(column, row));
            all += light;
            if (open(column, row) != 0) {
                left += light;
                x += light * ((column + 0.5) / open.width - 0.5);
                y += light * ((row + 0.5) / open.height - 0.5);
            }
        }
    }
    return left > 0 ? SeenShare{left / all, x / left, y / left} : SeenShare{0, 0, 0};
}

std::map<ClassKey, std::vector<std::size_t>> classes_of(const std::vector<SeenShare>& seen, int most) {
    for (double steps = 12;; steps *= 0.7) {
        std::map<ClassKey, std::vector<std::size_t>> classes;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (seen[i].share > 0 && seen[i].share < 1 - 1e-6) classes[key_of(seen[i], steps)].push_back(i);
        }
        if (classes.size() <= static_cast<std::size_t>(most)) return classes;
    }
}

std::size_t typical(const std::vector<std::size_t>& members, const std::vector<SeenShare>& seen) {
    SeenShare mean{0, 0, 0};
    const double share = 1.0 / static_cast<double>(members.size());
    for (const std::size_t i : members)
        mean = {mean.share + share * seen[i].share, mean.x + share * seen[i].x, mean.y + share * seen[i].y};
    std::size_t best = members.front();
    double least = 1e300;
    for (const std::size_t i : members) {
        const double d = (seen[i].share - mean.share) * (seen[i].share - mean.share) +
                         (seen[i].x - mean.x) * (seen[i].x - mean.x) +
                         (seen[i].y - mean.y) * (seen[i].y - mean.y);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

}  // namespace obscura
