// Message flood: clients that send messages of one kind as fast as the server reads them. The
// contents are drawn (tests/support/codec/random_message.hpp) and valid, and the numbers are those
// of a client that keeps to the protocol, so that the server does not refuse a message for its
// form.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/hash.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone::bench {

class AttackThread;

/// Returns the kinds that a client may send, in the order of the table.
std::vector<MessageKind> client_kinds();

/// The messages of a flood.
class FloodMessages {
 public:
  /// Draws messages that are valid in a world of this chunk edge. Requires a kind that a client may
  /// send.
  FloodMessages(MessageKind kind, std::uint16_t edge, SplitMix64& random);
  /// Begins with the numbers of a new session.
  void restart() { count_ = 0; }
  runstone::Message next();

 private:
  std::vector<runstone::Message> drawn_;
  std::uint64_t count_ = 0;  // since restart()
};

/// Plays one thread of the flood until its time is over. The thread has one connection, and a new
/// one whenever the server ends it. Messages of the handshake are sent in the stage to which they
/// belong.
void flood_messages(AttackThread& thread, MessageKind kind);

}  // namespace runstone::bench
