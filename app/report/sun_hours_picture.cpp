#include "app/report/sun_hours_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/frame/sun_hours_text.h"
#include "lessons/drawing/figure.h"

namespace obscura {
namespace {

constexpr int scale_rows = 48, least_width = 160;
constexpr double side_px = 16, bar_px = 14, cap_px = 9;
constexpr Rgb8 nothing{205, 205, 205};

/// Whole hours between ticks, so that their numbers keep apart.
int hours_between_ticks(double span_h, double length_px) {
    constexpr double room_px = 44;
    for (const int hours : {1, 2, 3, 4, 6, 12}) {
        if (hours * length_px >= room_px * span_h) return hours;
    }
    return 24;
}

/// The bar, its ticks and what they are, in a strip of its own.
Image<Rgb8> scale_strip(int width, const SunHoursStats& stats) {
    Figure strip(width, scale_rows);
    const double span = stats.sunlit_h();
    const Lettering plain{cap_px, ink::dark, Align::left, false, false};
    const Lettering number{cap_px, ink::dark, Align::centre, false, false};
    // The title goes beside the bar where there is room for both.
    const std::string title = "hours of sun, " + date_text(stats.path);
    const double title_px = Figure::text_width(title, cap_px) + side_px;
    const bool titled = width > 2.5 * title_px;
    const double x0 = side_px + (titled ? title_px : 0), x1 = width - side_px - cap_px, y0 = 8;
    if (titled) strip.text({side_px, y0 + 0.5 * (bar_px + cap_px)}, title, plain);
    if (span <= 0) {
        strip.text({x0, y0 + 0.5 * (bar_px + cap_px)}, "no sun", plain);
        return strip.picture;
    }
    for (int x = static_cast<int>(std::ceil(x0)); x < static_cast<int>(x1); ++x)
        strip.fill({static_cast<double>(x), y0, 1, bar_px}, heat((x + 0.5 - x0) / (x1 - x0)));
    strip.frame({x0, y0, x1 - x0, bar_px}, {ink::dark, 1, 0});
    const int step = hours_between_ticks(span, x1 - x0);
    for (int hour = 0; hour <= span; hour += step) {
        const double x = x0 + (x1 - x0) * hour / span;
        strip.line({x, y0 + bar_px}, {x, y0 + bar_px + 4}, {ink::dark, 1, 0});
        strip.text({x, y0 + bar_px + 8 + cap_px}, fmt::format("{} h", hour), number);
    }
    return strip.picture;
}

}  // namespace

int sun_hours_scale_rows(int width) {
    return width >= least_width ? scale_rows : 0;
}

Image<Rgb8> sun_hours_picture(ImageView<const float> hours, const SunHoursStats& stats) {
    const double span = stats.sunlit_h();
    Image<Rgb8> picture(hours.width, hours.height + sun_hours_scale_rows(hours.width));
    for (int y = 0; y < hours.height; ++y) {
        std::transform(hours.row(y), hours.row(y) + hours.width, picture.row(y), [&](float h) {
            if (std::isnan(h)) return nothing;
            return heat(span > 0 ? static_cast<double>(h) / span : 0.0);
        });
    }
    if (picture.height == hours.height) return picture;
    const Image<Rgb8> strip = scale_strip(hours.width, stats);
    for (int y = 0; y < strip.height; ++y)
        std::copy_n(strip.row(y), strip.width, picture.row(hours.height + y));
    return picture;
}

}  // namespace obscura
