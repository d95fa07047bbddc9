// An SVG file: one chart with its style sheet, for a page that has none, such as Markdown.
#pragma once
#include <string>

namespace runstone::bench::chart {

/// Returns the file of a chart that svg_of() returned. Its colours follow the reader's theme.
std::string svg_file_of(std::string svg);

}  // namespace runstone::bench::chart
