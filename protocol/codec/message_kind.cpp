#include "protocol/codec/message_kind.hpp"

#include <array>
#include <utility>

#include "common/core/assert.hpp"
#include "protocol/schema/runstone_generated.h"

namespace runstone {
namespace {

// Order of Message follows the union of the schema, whose first value says that there is no body.
constexpr std::size_t kFirst = static_cast<std::size_t>(wire::Body::NONE) + 1;
static_assert(static_cast<std::size_t>(wire::Body::MAX) + 1 - kFirst == kMessageKindCount);

template <std::size_t... kKind>
std::array<FrameClass, kMessageKindCount> classes(std::index_sequence<kKind...> /*all*/) {
  return {frame_class_of(Message(std::in_place_index<kKind>))...};
}

}  // namespace

MessageKind kind_of(ByteView message) {
  const auto type = static_cast<std::size_t>(wire::GetMessage(message.data())->body_type());
  RUNSTONE_ASSERT(type >= kFirst && type - kFirst < kMessageKindCount);
  return type - kFirst;
}

FrameClass class_of_kind(MessageKind kind) {
  static const std::array<FrameClass, kMessageKindCount> kClasses =
      classes(std::make_index_sequence<kMessageKindCount>());
  RUNSTONE_ASSERT(kind < kMessageKindCount);
  return kClasses[kind];
}

KindTraffic of_class(const Traffic& traffic, FrameClass frame_class) {
  KindTraffic sum;
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (class_of_kind(kind) == frame_class) sum += traffic[kind];
  }
  return sum;
}

const char* name_of_kind(MessageKind kind) {
  RUNSTONE_ASSERT(kind < kMessageKindCount);
  return wire::EnumNameBody(static_cast<wire::Body>(kind + kFirst));
}

}  // namespace runstone
