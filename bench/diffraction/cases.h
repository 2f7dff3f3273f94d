#pragma once
// The apertures of the diffraction bench.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "optics/field/aperture.h"

namespace obscura {

/// One aperture at one size, as the thesis uses it: an anti-aliased image of size x size texels, and the
/// binary mask of half that size which is the finest level of its quadtree.
struct DiffractionCase {
    std::string aperture;
    int size = 0;
    Aperture image, mask;
    bool convex = false;
};

/// "box", "circle", "heptagon", "whirl", and of real telescopes "jwst", "keck".
std::vector<std::string> aperture_names(const std::optional<std::filesystem::path>& data);

/// Nothing when the aperture cannot be had at this size: masks of telescopes have 1024 texels, which serve as
/// the image of size 1024 or, each texel as 2 x 2, as the mask of size 2048. Throws InputError for files that
/// cannot be read.
std::optional<DiffractionCase> diffraction_case(const std::string& aperture, int size,
                                                const std::optional<std::filesystem::path>& data);

}  // namespace obscura
