#include "server/web/map_page.hpp"

namespace runstone {

std::string_view map_style() {
  return R"(* { box-sizing: border-box; }
html, body { margin: 0; height: 100%; overflow: hidden; font: 0.95rem/1.4 sans-serif; color: #e8e8e4;
  background: #15171a; }
canvas { position: fixed; inset: 0; width: 100%; height: 100%; touch-action: none; cursor: grab;
  outline: none; }
canvas.drag { cursor: grabbing; }
header, footer, aside, #words, nav { position: fixed; background: #1b1e22e0; border-radius: 0.4rem; }
header { left: 0.6rem; top: 0.6rem; padding: 0.3rem 0.7rem; }
h1, h2 { font-size: 1rem; margin: 0; display: inline; }
h2 { display: block; padding-right: 1.5rem; overflow-wrap: anywhere; }
a { color: #9ccaf2; text-decoration: none; }
#place { margin-left: 0.8rem; font-variant-numeric: tabular-nums; color: #b8bcc0; }
#words { left: 50%; top: 40%; transform: translate(-50%); max-width: 90%; margin: 0; }
#words:not(:empty) { padding: 0.6rem 1rem; }
nav { right: 0.6rem; top: 0.6rem; display: grid; }
nav button { width: 2.2rem; height: 2.2rem; font-size: 1.3rem; }
button { font: inherit; color: inherit; background: none; border: 0; cursor: pointer;
  padding: 0.3rem 0.6rem; border-radius: 0.4rem; }
button:hover, button:focus-visible { background: #ffffff22; }
footer { left: 0.6rem; right: 0.6rem; bottom: 0.6rem; padding: 0.3rem; display: flex; gap: 0.4rem;
  align-items: center; }
footer[hidden], aside[hidden] { display: none; }
#moment { flex: 1; min-width: 4rem; accent-color: #f2b64c; }
#when { font-variant-numeric: tabular-nums; min-width: 11rem; text-align: right; }
footer.past #now { color: #f2b64c; }
aside { right: 3.6rem; top: 0.6rem; width: 24rem; max-width: calc(100% - 4.4rem); max-height: 70%;
  overflow: auto; padding: 0.5rem 0.9rem; }
#close { position: absolute; right: 0.2rem; top: 0.2rem; }
ol { list-style: none; margin: 0.4rem 0 0; padding: 0; }
li { border-top: 1px solid #ffffff22; padding: 0.4rem 0; overflow-wrap: anywhere; }
li time, li code { color: #b8bcc0; }
code { display: block; font-size: 0.8rem; user-select: all; }
@media (max-width: 40rem) { #when { min-width: 0; font-size: 0.8rem; } #place { display: block; margin: 0; } }
)";
}

}  // namespace runstone
