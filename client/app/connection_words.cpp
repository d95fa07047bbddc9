#include "client/app/connection_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace runstone {
namespace {

std::string unconfirmed_text(std::size_t edits) {
  return fmt::format("{} of your edits {} not confirmed, and may be lost.", edits,
                     edits == 1 ? "was" : "were");
}

}  // namespace

ConnectingState connecting_state(const ThreadedSession& network, bool was_open, bool is_encrypted,
                                 TimeUs now_us) {
  ConnectingState out;
  const ClientSession& session = network.session();
  if (was_open) {
    const std::size_t all = session.is_open() ? session.view_chunks() : 0;
    const std::size_t here = std::min(session.replica().current_count(), all);
    out.step = fmt::format("receiving the world: {} of {} chunks", here, all);
    if (all != 0) out.progress = static_cast<double>(here) / static_cast<double>(all);
    return out;
  }
  switch (session.state()) {
    case SessionState::offline:
      out.step = is_encrypted ? "connecting, encrypted" : "connecting";
      break;
    case SessionState::hello_sent:
      out.step = "greeting the server";
      break;
    default:
      out.step = "showing the key to the server";
      break;
  }
  const FailureWords words = network.failure_words();
  if (words.headline.empty()) return out;
  out.detail = fmt::format("{}. Trying again for {:.0f} s.\n{}", words.headline,
                           network.seconds_left(now_us), words.detail);
  return out;
}

PauseState pause_state(const ClientSession& session) {
  PauseState out;
  const std::size_t others = session.others().size();
  if (others != 0)
    out.players =
        others == 1 ? "one other player is here" : fmt::format("{} others are here", others);
  return out;
}

std::string lost_text(const ThreadedSession& network, TimeUs now_us) {
  if (network.is_connected()) return {};
  const std::size_t waiting = network.session().replica().local_edits().pending_count();
  std::string out = fmt::format("the server is gone: connecting again, {:.0f} s left",
                                network.seconds_left(now_us));
  if (waiting != 0) out += fmt::format("; {} edits wait for it", waiting);
  return out;
}

FailureWords failure_words(const ThreadedSession& network) {
  FailureWords words = network.failure_words();
  const std::size_t waiting = network.session().replica().local_edits().pending_count();
  if (waiting == 0) return words;
  if (!words.detail.empty()) words.detail += "\n";
  words.detail += unconfirmed_text(waiting);
  return words;
}

FailureWords leaving_words(const ThreadedSession& network) {
  const std::size_t waiting = network.session().replica().local_edits().pending_count();
  // A connected server gets the edits before the goodbye.
  if (waiting == 0 || network.is_connected()) return {};
  return {"You left while the server was gone", unconfirmed_text(waiting)};
}

}  // namespace runstone
