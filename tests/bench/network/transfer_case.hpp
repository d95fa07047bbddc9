// The thesis' question: when does compressed transfer plus RDM win, by how much, and when not? Each scene (the 37
// scenarios as 27 chunks, and 64 chunks of each world) goes in each form through each link over a fresh TCP connection
// from a sender to a receiver of ours; the receiver unpacks and meshes chunks as they come. Encoding is not in the
// time: a server does it once.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_transfers(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
