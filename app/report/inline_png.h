#pragma once
// Pictures as part of a page that needs nothing but itself.

#include <string>
#include <string_view>

namespace obscura {

/// RFC 4648, section 4, with padding.
std::string base64(std::string_view bytes);

/// <img> whose picture is in the page. `alt` is text, not HTML.
std::string inline_png(std::string_view png, std::string_view alt);

}  // namespace obscura
