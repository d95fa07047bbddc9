// The latency of an edit until it is meshed by another client, stage by stage, on each link: idle,
// while terrain streams, and while terrain streams among twenty clients, with a plain Asio echo
// beside it. Two clients (no drawing, one mesh worker) edit the same place with 50 edits a second
// each at fixed times; latency counts from those times. While terrain streams, both clients fly to
// and fro, so that chunks leave and enter the view all the time and the place of the edits stays in
// view. Each figure is the worse one of the two clients.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_latency(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
