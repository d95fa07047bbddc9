#pragma once
#include <string_view>

namespace runstone::bench {

/// The style of the page around the charts; colours come from chart_css().
inline constexpr std::string_view kPageStyle = R"css(
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0 auto;max-width:60rem;padding:1rem 1rem 4rem;font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper,Canvas)}
h1{font-size:1.7rem;line-height:1.2;margin:.5rem 0}
h2{font-size:1.35rem;margin:3rem 0 .25rem}
h3{font-size:1.05rem;margin:0 0 .35rem}
p{margin:.35rem 0;max-width:46rem}
a{color:inherit}
.quiet,figcaption small,footer{color:var(--quiet);font-size:.85rem}
.answer{font-size:1.12rem;max-width:46rem}
table{border-collapse:collapse;width:100%;margin:1rem 0;font-size:.92rem}
td,th{text-align:left;vertical-align:top;padding:.35rem .6rem .35rem 0;border-top:1px solid var(--grid)}
th{font-weight:600;border-top:0}
figure{margin:1.6rem 0 2.4rem;break-inside:avoid}
figure .chart-frame{margin:.6rem 0}
nav{margin:1rem 0;font-size:.92rem}
nav a{margin-right:1rem;white-space:nowrap}
.doubt{border-left:3px solid var(--baseline);padding-left:.6rem;font-size:.9rem;overflow-wrap:anywhere}
details{font-size:.85rem;color:var(--quiet)}
code{font-size:.85em;overflow-wrap:anywhere}
@media (max-width:40rem){
 .verdicts thead{display:none}
 .verdicts td{display:block;border-top:0;padding:.1rem 0}
 .verdicts tr{display:block;border-top:1px solid var(--grid);padding:.4rem 0}
 .verdicts td+td::before{content:attr(data-head)": ";color:var(--quiet)}
}
@media print{nav,details,.csv{display:none}body{max-width:none;font-size:11pt}h2{break-before:page}}
)css";

}  // namespace runstone::bench
