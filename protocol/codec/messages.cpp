#include "protocol/codec/messages.hpp"

#include <type_traits>
#include <variant>

namespace runstone {

FrameClass frame_class_of(const Message& message) {
  return std::visit(
      []<class T>(const T&) {
        constexpr bool kOrder = std::is_same_v<T, EditRequest> || std::is_same_v<T, Commit> ||
                                std::is_same_v<T, Reject> || std::is_same_v<T, Durable> ||
                                std::is_same_v<T, Ready>;
        if constexpr (kOrder) return FrameClass::edits;
        return std::is_same_v<T, ChunkSnapshot> ? FrameClass::chunks : FrameClass::control;
      },
      message);
}

const char* to_string(RejectReason reason) {
  switch (reason) {
    case RejectReason::busy:
      return "busy";
    case RejectReason::already_decided:
      return "already decided";
    case RejectReason::unknown_material:
      return "unknown material";
    case RejectReason::too_large:
      return "too large";
    case RejectReason::out_of_reach:
      return "out of reach";
    case RejectReason::not_permitted:
      return "not permitted";
    case RejectReason::rate_limited:
      return "rate limited";
    case RejectReason::bad_edit:
      return "bad edit";
  }
  return "unknown";
}

const char* to_string(GoodbyeReason reason) {
  switch (reason) {
    case GoodbyeReason::closing:
      return "closing";
    case GoodbyeReason::wrong_protocol:
      return "wrong protocol";
    case GoodbyeReason::malformed_frame:
      return "malformed frame";
    case GoodbyeReason::malformed_message:
      return "malformed message";
    case GoodbyeReason::unexpected_message:
      return "unexpected message";
    case GoodbyeReason::not_authenticated:
      return "not authenticated";
    case GoodbyeReason::already_connected:
      return "already connected";
    case GoodbyeReason::server_full:
      return "server full";
    case GoodbyeReason::timed_out:
      return "timed out";
    case GoodbyeReason::flooding:
      return "flooding";
    case GoodbyeReason::internal:
      return "internal error";
  }
  return "unknown";
}

}  // namespace runstone
