#include "tests/bench/report/chart/chart_css.hpp"

#include <fmt/format.h>

#include <string_view>

namespace runstone::bench::chart {
namespace {

// Okabe and Ito's palette for all kinds of colour vision, darker on white and lighter on black.
// Each colour has three times the contrast that a mark needs to be seen (WCAG 2.1, 1.4.11), and
// text 4.5 times (1.4.3).
constexpr std::string_view kLight =
    "--paper:#fff;--ink:#1b1f24;--quiet:#5a646f;--grid:#e4e8ec;--axis:#9aa4af;"
    "--ours:#0067b1;--baseline:#c85200;--thesis:#6d7580;--rest:#8592a0;"
    "--ours2:#00355f;--baseline2:#742f00;--thesis2:#3f464e;"
    "--other0:#00835d;--other1:#a8508a;--other2:#2f8fc0;--other3:#9a7b00;"
    "--other4:#7a4a28;--other5:#6a5acd;--other6:#4b7a80;--other7:#66741c;"
    "--heat0:#08519c;--heat1:#2f72b3;--heat2:#7fb0da;--heat3:#bcd7ec;--heat4:#f0f0ec;"
    "--heat5:#fbd9b5;--heat6:#f0a35c;--heat7:#bd5c17;--heat8:#883a00;"
    "--heat-ends:#fff;--heat-middle:#1b1f24;";
constexpr std::string_view kDark =
    "--paper:#14181d;--ink:#e6e9ed;--quiet:#a3acb7;--grid:#2b323a;--axis:#5d6874;"
    "--ours:#4aa8f0;--baseline:#ff9248;--thesis:#a9b2bc;--rest:#738190;"
    "--ours2:#b4dcfc;--baseline2:#ffd3b0;--thesis2:#dce1e6;"
    "--other0:#35c79a;--other1:#e08fc2;--other2:#8fd3f7;--other3:#e2c23a;"
    "--other4:#c89a6b;--other5:#a79cf5;--other6:#7fb5bd;--other7:#b5c252;"
    "--heat0:#66bbff;--heat1:#4796dc;--heat2:#2f6ca6;--heat3:#274e75;--heat4:#2f343b;"
    "--heat5:#5a4330;--heat6:#8a5a2c;--heat7:#cf822f;--heat8:#ffab58;"
    "--heat-ends:#0d1013;--heat-middle:#e6e9ed;";

constexpr std::string_view kRules = R"(
.chart-frame{container-type:inline-size;margin:0 auto;max-width:880px}
.chart{display:block;width:100%;height:auto;font-family:system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif;print-color-adjust:exact;-webkit-print-color-adjust:exact}
.chart-frame .narrow{display:none;max-width:480px;margin:0 auto}
@container (max-width:600px){.chart-frame .wide{display:none}.chart-frame .narrow{display:block}}
.chart text{font-size:12px;fill:var(--ink)}
.chart .tick,.chart .note{font-size:11px;font-variant-numeric:tabular-nums}
.chart .quiet,.chart .note,.chart .tick{fill:var(--quiet)}
.chart .strong{font-weight:700}
.chart .mid{text-anchor:middle}
.chart .end{text-anchor:end}
.chart .grid{stroke:var(--grid);stroke-width:1}
.chart .axis{stroke:var(--axis);stroke-width:1}
.chart .fill{fill:var(--c)}
.chart .halo{stroke:var(--paper);stroke-width:1}
.chart .hollow{fill:var(--paper);stroke:var(--c);stroke-width:1}
.chart .ring{stroke-width:1.8}
.chart .hatch{stroke:var(--c);stroke-width:1.1;fill:none}
.chart .line{stroke:var(--c);stroke-width:1.8;fill:none;stroke-linejoin:round;stroke-linecap:round}
.chart .strong-line{stroke-width:3}
.chart .dashed{stroke-dasharray:5 4;stroke-linecap:butt}
.chart .lead{stroke:var(--c,var(--axis));stroke-width:.9;fill:none;opacity:.75}
.chart .whisker{stroke:var(--c);stroke-width:1.4}
.chart .gap{fill:var(--paper)}
.chart .ink{fill:var(--ink)}
.chart .shade{fill:var(--rest);opacity:.18}
.chart .missing{stroke:var(--quiet);stroke-width:1.3;fill:none}
.chart .no-heat{fill:none;stroke:var(--grid)}
.chart .arrow{stroke:var(--quiet);stroke-width:1.4;fill:none;stroke-linecap:round;stroke-linejoin:round}
.chart .mark:hover .fill{opacity:.8}
.chart .c-ours{--c:var(--ours)}
.chart .c-baseline{--c:var(--baseline)}
.chart .c-thesis{--c:var(--thesis)}
.chart .c-rest{--c:var(--rest)}
.chart .c-ours2{--c:var(--ours2)}
.chart .c-baseline2{--c:var(--baseline2)}
.chart .c-thesis2{--c:var(--thesis2)}
)";

}  // namespace

std::string chart_css() {
  std::string out = fmt::format(
      ":root{{{}}}\n@media screen and "
      "(prefers-color-scheme:dark){{:root:not([data-theme=light]){{{}}}}}\n"
      "@media screen{{:root[data-theme=dark]{{{}}}}}{}",
      kLight, kDark, kDark, kRules);
  for (int i = 0; i < 8; ++i) out += fmt::format(".chart .c-other{0}{{--c:var(--other{0})}}\n", i);
  for (int i = 0; i < 9; ++i) {
    const bool is_end = i < 2 || i > 6;
    out += fmt::format(
        ".chart .heat{0}{{--c:var(--heat{0})}}\n.chart .on-heat{0}{{fill:var(--heat-{1})}}\n", i,
        is_end ? "ends" : "middle");
  }
  return out;
}

}  // namespace runstone::bench::chart
