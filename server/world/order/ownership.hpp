// Ownership: the part that this server plays in its world, as one state with named transitions.
//
//   owning -- begin_following() --> following
//   owning -- begin_handover() --> handing_over -- end_handover() --> following
//   following -- begin_takeover() --> taking_over -- end_takeover() --> owning
//
//   lose_log()       owning -> log_lost,  handing_over -> handover_failed
//   find_fork()      following, taking_over -> forked
//   fail_takeover()  taking_over -> takeover_failed
//  The lease of the world (server/store/postgres_lease.hpp) goes with it: a server has the lease
// while it owns the world, hands it over, or takes it over. The lease alone keeps two servers from
// writing. A server whose lease may have run out still owns the world here, and orders nothing
// meanwhile (WorldEnvironment::owns_world()). How a server is connected with the owner is no part
// of this state (OwnerLink), and neither is whether the server stops.
// Threads: state() any.
// Transitions are made one at a time: on the world strand, or by the caller of a takeover or
// handover while the strand makes none.
#pragma once
#include <atomic>
#include <cstdint>

namespace runstone {

enum class OwnershipState : std::uint8_t {
  owning,        // orders edits and writes the log
  handing_over,  // orders no edit any more, and writes the rest of the log
  following,     // another server owns the world, or none does
  taking_over,   // writes what the earlier owner may not have written
  // The server must be stopped:
  log_lost,         // it owned the world, and cannot write the log any more
  handover_failed,  // it could not write the rest of the log; the other servers have these edits
  forked,           // it has edits that the log does not have, or has others there
  takeover_failed,  // it had the lease, and the database failed
};

/// Returns true if no other server orders edits, as far as this server knows: it owns the world, or
/// has lost its log. Otherwise what players do waits for an owner, or goes to it.
constexpr bool owns(OwnershipState state) {
  return state == OwnershipState::owning || state == OwnershipState::log_lost;
}
/// Returns true if the server can neither own the world nor follow its owner any more.
constexpr bool has_failed(OwnershipState state) { return state >= OwnershipState::log_lost; }

class Ownership {
 public:
  /// A server owns its world unless it begins with begin_following().
  Ownership() = default;
  Ownership(const Ownership&) = delete;
  Ownership& operator=(const Ownership&) = delete;

  OwnershipState state() const { return state_.load(); }
  bool is(OwnershipState state) const { return state_.load() == state; }

  // Each transition requires that the server is in a state from which it leads, as the table above
  // says.
  /// The server starts while another one owns the world. No other transition may come before it.
  void begin_following();
  /// The server orders nothing from now on, because another one is to take the world over.
  void begin_handover();
  /// The log is complete, and the caller gives the lease up.
  void end_handover();
  /// The server has the lease. It may have forked: TakeoverWatch stops a server that has forked,
  /// but the fork may be found after it has looked. Then the log decides: end_takeover() or
  /// find_fork().
  void begin_takeover();
  /// The log is the one that this server has.
  void end_takeover();

  /// The log cannot be written any more. In a state without a log nothing changes: the report of a
  /// log that has ended may come late.
  void lose_log();
  /// The log has other edits than this server. It may be found again.
  void find_fork();
  /// The database failed before the log was complete.
  void fail_takeover();

 private:
  bool try_to_move(OwnershipState from, OwnershipState to);
  void move(OwnershipState from, OwnershipState to);

  std::atomic<OwnershipState> state_{OwnershipState::owning};
};

}  // namespace runstone
