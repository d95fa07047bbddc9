// Map attacks: strangers who request tiles of the map from the gateway. Each function plays one
// thread until its time is over.
#pragma once

namespace runstone::bench {

class AttackThread;

/// Keeps eight requests for random tiles open, each from another /24. Requires a gateway.
void request_random_tiles(AttackThread& thread);

}  // namespace runstone::bench
