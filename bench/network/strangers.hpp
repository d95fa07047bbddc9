// Strangers: thousands of connections that come as far as a stage and then say nothing or little.
// One thread holds all of them, so that they cost the machine little and the figures show what they
// cost the server. Whoever the server ends comes again, with a pause.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace runstone::bench {

class AttackThread;

/// How far a stranger comes.
enum class StrangerStage : std::uint8_t {
  socket,    // connects and sends nothing
  half_tls,  // sends the first message of the TLS handshake, and does not read the answer
  slow_tls,  // sends a byte a second of that message
  tls,       // completes the TLS handshake and sends nothing
  message,   // the same, and sends all but the last byte of the largest message
  hello,     // sends hello and does not answer welcome
  unread,    // joins with a view of the largest radius, and does not read
};

struct StrangerSort {
  const char* name;
  const char* what;  // a description for readers
  std::vector<StrangerStage> stages;
};
/// Returns a sort for each stage, and one with all of them in turn.
std::span<const StrangerSort> stranger_sorts();

inline constexpr unsigned kStrangersPerSecond = 1'000;  // that connect at most

/// Holds `count` strangers until the thread's time is over. Their stages are those of `stages` in
/// turn, and their addresses all those of the thread's plan. Requires that the process may open so
/// many sockets.
void hold_strangers(AttackThread& thread, std::span<const StrangerStage> stages, unsigned count);

}  // namespace runstone::bench
