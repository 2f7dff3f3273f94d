// Smaller middle views, by sampling; see middle_view.h.

#include "stereo/middle_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace obscura {
namespace {

template <class T>
Image<T> sampled(const Image<T>& image, int reduction) {
    if (image.pixels.empty()) return {};
    Image<T> small((image.width + reduction - 1) / reduction, (image.height + reduction - 1) / reduction);
    for (int y = 0; y < small.height; ++y) {
        const T* from = image.row(sampled_pixel(y, reduction, image.height));
        for (int x = 0; x < small.width; ++x)
            small(x, y) = from[sampled_pixel(x, reduction, image.width)];
    }
    return small;
}

}  // namespace

int sampled_pixel(int index, int reduction, int full_size) {
    return std::min(index * reduction + (reduction - 1) / 2, full_size - 1);
}

MiddleView reduced(const MiddleView& view, int reduction) {
    CHECK(view.reduction == 1 && (reduction == 1 || reduction == 2 || reduction == 4 || reduction == 8),
          fmt::format("{} of {}", reduction, view.reduction));
    MiddleView small;
    small.picture_width = view.picture_width;
    small.picture_height = view.picture_height;
    small.margin_px = view.margin_px;
    small.reduction = reduction;
    small.depth_m = sampled(view.depth_m, reduction);
    small.normal = sampled(view.normal, reduction);
    small.object = sampled(view.object, reduction);
    small.material = sampled(view.material, reduction);
    small.triangle = sampled(view.triangle, reduction);
    small.disparity = sampled(view.disparity, reduction);
    return small;
}

}  // namespace obscura
