#pragma once
// What sections of a report are made of.

#include <string>

#include "core/image.h"
#include "core/vec.h"

namespace obscura {

/// `picture` is markup, `caption` is escaped already.
std::string page_figure(const std::string& picture, const std::string& caption);

/// A heading, a paragraph of `text` unless it is empty, and `body`, all of them markup.
std::string page_section(const char* title, const std::string& text, const std::string& body);

/// The whole fraction at which a picture this wide is shown: 1, 2, ...
int shrink_of(int width);

/// A picture at that fraction: averages of linear light over whole pixels.
Image<Vec3f> shrunk(const Image<Vec3f>& picture);

}  // namespace obscura
