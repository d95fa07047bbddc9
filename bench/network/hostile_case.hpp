// Hostile case: what fifty builders notice of thousands of strangers, and of floods of messages.
// Each row has a server of its own with default settings: builders before, and the same number of
// builders during the attack.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

/// Measures half-open, slow and silent connections in each stage of the handshake: all from one
/// address, and from many.
Done measure_strangers(Testbed& testbed, NetFindings& findings);
/// Measures a flood of each kind of message that a client may send.
Done measure_floods(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
