#include "protocol/codec/messages.hpp"

#include "protocol/codec/chunk_lists.hpp"

namespace runstone {

std::vector<Message> cached_chunks_messages(std::span<const CachedChunk> chunks) {
  std::vector<Message> out;
  while (!chunks.empty()) {
    const std::size_t count = cached_chunks_that_fit(chunks);
    out.push_back(
        CachedChunks{{chunks.begin(), chunks.begin() + static_cast<std::ptrdiff_t>(count)}});
    chunks = chunks.subspan(count);
  }
  return out;
}

const char* to_string(RejectReason reason) {
  switch (reason) {
    case RejectReason::busy:
      return "busy";
    case RejectReason::already_resolved:
      return "already_resolved";
    case RejectReason::unknown_material:
      return "unknown_material";
    case RejectReason::too_large:
      return "too_large";
    case RejectReason::out_of_reach:
      return "out_of_reach";
    case RejectReason::not_permitted:
      return "not_permitted";
    case RejectReason::rate_limited:
      return "rate_limited";
    case RejectReason::bad_edit:
      return "bad_edit";
    case RejectReason::outside_world:
      return "outside_world";
    case RejectReason::unknown_action:
      return "unknown_action";
    case RejectReason::action_ended:
      return "action_ended";
  }
  return "unknown";
}

const char* to_string(UnavailableReason reason) {
  return reason == UnavailableReason::damaged ? "damaged" : "unknown";
}

const char* to_string(GoodbyeReason reason) {
  switch (reason) {
    case GoodbyeReason::closing:
      return "closing";
    case GoodbyeReason::wrong_protocol:
      return "wrong_protocol";
    case GoodbyeReason::malformed_frame:
      return "malformed_frame";
    case GoodbyeReason::malformed_message:
      return "malformed_message";
    case GoodbyeReason::unexpected_message:
      return "unexpected_message";
    case GoodbyeReason::not_authenticated:
      return "not_authenticated";
    case GoodbyeReason::already_connected:
      return "already_connected";
    case GoodbyeReason::server_full:
      return "server_full";
    case GoodbyeReason::timed_out:
      return "timed_out";
    case GoodbyeReason::flooding:
      return "flooding";
    case GoodbyeReason::internal:
      return "internal";
    case GoodbyeReason::name_refused:
      return "name_refused";
    case GoodbyeReason::not_admitted:
      return "not_admitted";
  }
  return "unknown";
}

}  // namespace runstone
