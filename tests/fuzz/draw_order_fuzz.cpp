// The target reads any bytes as draw orders. Input: 1 byte that seeds the split, then the stream.
// The stream must give the same orders however it is split. Each order must be inside its limits
// and come back unchanged when it is encoded again.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "protocol/codec/draw_order.hpp"

using namespace runstone;

namespace {

struct Outcome {
  Bytes again;  // the orders, encoded again
  std::size_t orders = 0;
  bool failed = false;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

struct Rewrite {
  Bytes& out;
  void operator()(const DrawWorld& world) const {
    append_draw_world(world.edge, world.materials, out);
  }
  void operator()(const DrawChunk& chunk) const {
    RUNSTONE_ASSERT(validate(chunk.voxels).has_value());
    append_draw_chunk(chunk.key, chunk.voxels, out);
  }
  void operator()(const DrawForget& forget) const { append_draw_forget(forget.key, out); }
  void operator()(const DrawPicture& picture) const { append_draw_picture(picture, out); }
  void operator()(const DrawEnd&) const { append_draw_end(out); }
};

Outcome read(ByteView stream, std::uint64_t seed) {
  SplitMix64 rng(seed);
  DrawOrderReader reader;
  Outcome out;
  while (!stream.empty() && !out.failed) {
    const std::size_t size =
        seed == 0 ? stream.size() : std::min<std::size_t>(stream.size(), 1 + rng.below(200));
    out.failed = !reader.feed(stream.first(size), [&](const DrawOrder& order) -> Result<void> {
      std::visit(Rewrite{out.again}, order);
      ++out.orders;
      return {};
    });
    stream = stream.subspan(size);
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const ByteView stream(data + 1, size - 1);
  const Outcome whole = read(stream, 0);
  RUNSTONE_ASSERT(read(stream, 1U + data[0]) == whole);
  const Outcome again = read(whole.again, 0);
  RUNSTONE_ASSERT(!again.failed && again.orders == whole.orders && again.again == whole.again);
  return 0;
}
