// The style sheet of all charts: colours for light and dark screens and for paper, as custom
// properties.
#pragma once
#include <string>

namespace runstone::bench::chart {

/// Returns the style sheet, for one <style> in the page. Its rules apply to .chart-frame and its
/// content. The colours are custom properties of :root (--ours, --baseline, --other0 .., --ink,
/// --quiet, --grid), so that a page can use them too. Dark follows the system's setting, or
/// data-theme="dark" or "light" of the root element if it is set.
std::string chart_css();

}  // namespace runstone::bench::chart
