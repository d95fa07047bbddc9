// The files of server/web/page, which the build embeds (cmake/embed.cmake). They are written by
// hand and load nothing from elsewhere. docs/server-reference.md describes the requests of the
// map's script.
#pragma once
#include <string_view>

namespace runstone {

/// Returns the page of the map. The page has "{title}" in place of the world's title.
std::string_view map_html();
std::string_view map_css();
std::string_view map_js();
/// Returns the style sheet of all other pages.
std::string_view style_css();

}  // namespace runstone
