#pragma once
// Pieces of pages that need nothing but themselves.

#include <string>
#include <string_view>

namespace obscura {

/// Text as HTML and SVG want it, inside of elements and of quoted attributes. Control characters other than
/// line ends and tabs, which no page may have, become U+FFFD.
std::string html_text(std::string_view text);

/// RFC 4648, section 4, with padding.
std::string base64(std::string_view bytes);

/// <img> whose picture is in the page. `alt` is text, not HTML.
std::string inline_png(std::string_view png, std::string_view alt);

}  // namespace obscura
