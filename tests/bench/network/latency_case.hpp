// The way of an edit to another client's mesh, stage by stage, under each link: idle, while terrain streams, and among
// twenty clients while terrain streams; with a bare Asio echo beside it.
// Two clients (no drawing, one mesh worker) edit the same place open loop, 50 edits a second each, from when they were
// due. While terrain streams both fly to and fro, so that chunks go out of view and come in again all the time, and the
// place of the edits stays in view. Each figure is that of the client for which it is worse.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_latency(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
