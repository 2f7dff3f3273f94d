#pragma once
// Text inside of pages and drawings that are text themselves.

#include <string>
#include <string_view>

namespace obscura {

/// Text as HTML and SVG want it, inside of elements and of quoted attributes. Control characters other than
/// line ends and tabs, which no page may have, become U+FFFD.
std::string html_text(std::string_view text);

}  // namespace obscura
