// The style sheet of all charts: colours for light and dark screens and for paper, in custom properties.
#pragma once
#include <string>

namespace runstone::bench::chart {

/// To stand once in the page's <style>. Everything it says is about .chart-frame and what is inside; the colours are
/// custom properties of :root (--ours, --baseline, --other0 .., --ink, --quiet, --grid), so that a page can use them too.
/// Dark follows the system's wish, or data-theme="dark" / "light" of the root element where it is set.
std::string chart_css();

}  // namespace runstone::bench::chart
