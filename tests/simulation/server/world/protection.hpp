// Protection: what keeps the servers of one world from harming it. A simulation can do without one
// of them, to show that it would notice.
#pragma once

namespace runstone::test {

enum class Protection {
  fence,         // a transaction confirms the lease before it commits
  locked_row,    // and nobody can take the lease between the two
  expiry,        // a lease is taken only when it has run out
  renewal,       // a renewal fails if somebody else has taken the lease
  owner_clock,   // an owner orders nothing once its lease may have run out
  epoch,         // whoever takes the world over raises the epoch
  durable_last,  // an edit is called durable after its transaction, not before
  watermarks,    // a server that starts knows the operations that the log has
  // These are in the product, and have no effect: the simulation alters what passes to it.
  resumed,     // edits that a client sent before it knew of the next owner are ignored
  head_epoch,  // a server that reads the log compares the epoch of its last record
};

}  // namespace runstone::test
