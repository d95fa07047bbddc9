// Session attacks: connections, seats, commands and bytes without meaning, and the two rows that
// are no attacks. Each function plays one thread until its time is over.
#pragma once

namespace runstone::bench {

class AttackThread;

void take_seats(AttackThread& thread);
void take_seats_of_range(AttackThread& thread);
void command_too_often(AttackThread& thread);
void open_halfway(AttackThread& thread);
void shake_hands(AttackThread& thread);
void send_garbage(AttackThread& thread);
/// This is no attack: it copies bytes between two sockets of its own. It shows how the load of the
/// machine affects the bots.
void keep_the_machine_busy(AttackThread& thread);
/// This is no attack: it does nothing, so that the bots are alone with the server.
void stay_away(AttackThread& thread);

}  // namespace runstone::bench
