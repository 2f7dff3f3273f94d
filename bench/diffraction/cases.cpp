#include "bench/diffraction/cases.h"

#include "app/models/file_access.h"
#include "core/image_io.h"
#include "optics/aperture_shapes.h"

namespace obscura {
namespace {

constexpr int file_size = 1024;
constexpr double diameter_m = 0.01;

struct NamedShape {
    const char* name;
    ApertureKind kind;
    bool convex;
};
constexpr NamedShape shapes[] = {
    {"box", ApertureKind::box, true},
    {"circle", ApertureKind::circle, true},
    {"heptagon", ApertureKind::iris, true},
    {"whirl", ApertureKind::whirl, false},
};

/// White is open.
Aperture read_mask(const std::filesystem::path& file) {
    const Image<Rgba8> picture = decode_png(read_file(file, std::int64_t{1} << 24), file.filename().string());
    Aperture aperture;
    aperture.pitch_m = diameter_m / picture.width;
    aperture.mask = Image<float>(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        aperture.mask.pixels[i] = picture.pixels[i].r >= 128 ? 1.0f : 0.0f;
    return aperture;
}

/// Every texel as 2 x 2.
Aperture doubled(const Aperture& from) {
    Aperture to;
    to.pitch_m = from.pitch_m / 2;
    to.mask = Image<float>(2 * from.mask.width, 2 * from.mask.height);
    for (int y = 0; y < to.mask.height; ++y) {
        for (int x = 0; x < to.mask.width; ++x)
            to.mask(x, y) = from.mask(x / 2, y / 2);
    }
    return to;
}

std::optional<Aperture> telescope_image(const std::string& name, int size,
                                        const std::optional<std::filesystem::path>& data) {
    if (!data || size > 2 * file_size) return std::nullopt;
    const Aperture whole = read_mask(*data / "apertures" / (name + "_1024.png"));
    if (size == 2 * file_size) return doubled(whole);
    int levels = 0;
    while (file_size >> levels > size)
        ++levels;
    return reduce(whole, levels, false);
}

}  // namespace

std::vector<std::string> aperture_names(const std::optional<std::filesystem::path>& data) {
    std::vector<std::string> names;
    for (const NamedShape& shape : shapes)
        names.emplace_back(shape.name);
    for (const char* name : {"jwst", "keck"}) {
        if (data) names.emplace_back(name);
    }
    return names;
}

std::optional<DiffractionCase> diffraction_case(const std::string& aperture, int size,
                                                const std::optional<std::filesystem::path>& data) {
    DiffractionCase made{aperture, size, {}, {}, false};
    for (const NamedShape& named : shapes) {
        if (aperture != named.name) continue;
        ApertureShape shape;
        shape.kind = named.kind;
        made.convex = named.convex;
        made.image = make_aperture(shape, size, diameter_m);
    }
    if (made.image.mask.pixels.empty()) {
        auto image = telescope_image(aperture, size, data);
        if (!image) return std::nullopt;
        made.image = std::move(*image);
    }
    made.mask = reduce(made.image, 1, true);
    return made;
}

}  // namespace obscura
