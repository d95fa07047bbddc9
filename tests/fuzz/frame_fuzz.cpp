// The target reads any bytes as a stream from either side. Input: 1 byte (bit 0: sender; the other
// bits seed the split), then the stream. The stream must give the same messages and the same result
// however it is split. No message may exceed its limit.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/core/hash.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"

namespace {

using namespace runstone;

struct Outcome {
  std::vector<Bytes> messages;  // the first byte is the kind
  bool failed = false;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome read(Sender sender, ByteView stream, std::uint64_t seed) {
  SplitMix64 rng(seed);
  FrameReader reader(sender);
  Outcome out;
  const auto take = [&](MessageKind kind, ByteView body) -> Result<void> {
    RUNSTONE_ASSERT(kind < kMessageKindCount && may_send(info_of(kind), sender));
    RUNSTONE_ASSERT(!body.empty() &&
                    body.size() <= message_bytes_max(sender, info_of(kind).frame_class));
    RUNSTONE_ASSERT(reinterpret_cast<std::uintptr_t>(body.data()) % 16 == 0);
    out.messages.push_back({static_cast<std::uint8_t>(kind)});
    out.messages.back().insert(out.messages.back().end(), body.begin(), body.end());
    return {};
  };
  while (!stream.empty()) {
    const std::size_t size =
        seed == 0 ? stream.size() : std::min<std::size_t>(stream.size(), 1 + rng.below(40));
    if (!reader.feed(stream.first(size), take)) {
      RUNSTONE_ASSERT(!reader.feed({}, take));
      out.failed = true;
      return out;
    }
    stream = stream.subspan(size);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Sender sender = (data[0] & 1) == 0 ? Sender::client : Sender::server;
  const ByteView stream(data + 1, size - 1);
  RUNSTONE_ASSERT(read(sender, stream, 0) == read(sender, stream, 1u + data[0]));
  return 0;
}
