// Map attacks: strangers who ask the gateway for pictures of the world. Each function plays one
// thread until its time is over.
#pragma once

namespace runstone::bench {

class AttackThread;

/// Requires a gateway.
void request_random_tiles(AttackThread& thread);

}  // namespace runstone::bench
