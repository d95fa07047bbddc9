// Edit attacks: sessions whose edits are too many, too large, too wide or costly to keep. Each
// function plays one thread of an attack until its time is over.
#pragma once

namespace runstone::bench {

class AttackThread;

void edit_too_often(AttackThread& thread);
void edit_too_much(AttackThread& thread);
void paste_much(AttackThread& thread);
void edit_widely(AttackThread& thread);
void build_tiny_chunks(AttackThread& thread);

}  // namespace runstone::bench
