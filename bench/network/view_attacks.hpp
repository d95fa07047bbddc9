// View attacks: sessions that misuse views, claims, requests of chunks and travels to the past.
// Each function plays one thread of an attack until its time is over.
#pragma once

namespace runstone::bench {

class AttackThread;

void never_read(AttackThread& thread);
void ping_unread(AttackThread& thread);
void read_a_byte_a_second(AttackThread& thread);
void flood_views(AttackThread& thread);
void flood_absurd_views(AttackThread& thread);
void claim_falsely(AttackThread& thread);
void request_chunks(AttackThread& thread);
void travel_too_often(AttackThread& thread);
void teleport(AttackThread& thread);
void spread_views(AttackThread& thread);

}  // namespace runstone::bench
