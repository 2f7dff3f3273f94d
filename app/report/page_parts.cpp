#include "app/report/page_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/report/pair_page.h"

namespace obscura {

std::string page_figure(const std::string& picture, const std::string& caption) {
    return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", picture, caption);
}

std::string page_section(const char* title, const std::string& text, const std::string& body) {
    return fmt::format("<section><h2>{}</h2>{}{}</section>\n", title,
                       text.empty() ? "" : "<p class=\"lead\">" + text + "</p>", body);
}

int shrink_of(int width) {
    return (width + report_picture_width - 1) / report_picture_width;
}

Image<Vec3f> shrunk(const Image<Vec3f>& picture) {
    const int n = shrink_of(picture.width);
    if (n == 1) return picture;
    Image<Vec3f> out(picture.width / n, std::max(picture.height / n, 1));
    const float share = 1.0f / static_cast<float>(n * n);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            Vec3f sum{0, 0, 0};
            for (int i = 0; i < n * n; ++i)
                sum = sum + picture(x * n + i % n, std::min(y * n + i / n, picture.height - 1)) * share;
            out(x, y) = sum;
        }
    }
    return out;
}

}  // namespace obscura
