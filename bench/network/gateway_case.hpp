// The gateway for browsers beside the server's own port, both on loopback and with TLS:
//   - round trips of single frames, which pass through both in turn;
//   - fleets of bots that build over WebSockets of one gateway, and by TCP, in turn.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_gateway(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
