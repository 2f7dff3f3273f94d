#pragma once
// Sources by what they see of the lens: those that see nearly the same of it share a pattern.

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/image.h"

namespace obscura {

/// Side of the visible pupils that sources are classed by.
constexpr int survey_texels = 32;

/// The aperture averaged onto the survey's texels.
Image<float> survey_of(const Image<float>& mask);

/// What of the open aperture a source sees: its share, and the way it lies from the middle (pupil sides).
struct SeenShare {
    double share = 1, x = 0, y = 0;
};
/// `open`: 1 where the lens is seen; of the survey's size.
SeenShare seen_share(const Image<std::uint8_t>& open, const Image<float>& survey);

/// Steps of share and place.
using ClassKey = std::tuple<int, int, int>;

/// Sources by class (indices into `seen`), at most `most` classes; sources that see all of the lens, or
/// nothing of it (what the picture shows beside the centre ray), are left out.
std::map<ClassKey, std::vector<std::size_t>> classes_of(const std::vector<SeenShare>& seen, int most);

/// The member of a class that is nearest to the class's mean.
std::size_t typical(const std::vector<std::size_t>& members, const std::vector<SeenShare>& seen);

}  // namespace obscura
