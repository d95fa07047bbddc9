// Protection: what keeps the servers of one world from harming it. A simulation can do without one of
// them, to show that it would notice.
#pragma once
#include <array>

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

inline constexpr std::array kProtections = {Protection::fence,        Protection::locked_row,
                                            Protection::expiry,       Protection::renewal,
                                            Protection::owner_clock,  Protection::epoch,
                                            Protection::durable_last, Protection::watermarks,
                                            Protection::resumed,      Protection::head_epoch};

constexpr const char* name_of(Protection protection) {
  switch (protection) {
    case Protection::fence:
      return "fence";
    case Protection::locked_row:
      return "locked row";
    case Protection::expiry:
      return "expiry";
    case Protection::renewal:
      return "renewal";
    case Protection::owner_clock:
      return "owner's clock";
    case Protection::epoch:
      return "epoch";
    case Protection::durable_last:
      return "durable last";
    case Protection::watermarks:
      return "watermarks";
    case Protection::resumed:
      return "resumed";
    case Protection::head_epoch:
      return "head epoch";
  }
  return "";
}

}  // namespace runstone::test
