#include "server/net/send_queue.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/core/hash.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone {
namespace {

/// Returns a message of a class, with bytes that have no meaning.
EncodedMessage message(FrameClass frame_class, std::size_t bytes, std::uint8_t fill = 1) {
  const MessageKind kind = frame_class == FrameClass::edits     ? kKindOf<Commit>
                           : frame_class == FrameClass::control ? kKindOf<PlayerPoses>
                                                                : kKindOf<ViewState>;
  return {kind, std::make_shared<const Bytes>(bytes, fill)};
}

ChunkKey key(std::int32_t x) { return {0, {x, 0, 0}}; }

/// Returns the entry of a chunk, with bytes that have no meaning.
ChunkEntry entry(std::int32_t x, std::size_t bytes, std::uint8_t fill = 1) {
  return {key(x), std::make_shared<const Bytes>(bytes, fill), 1};
}

/// Returns the message of chunks that were joined.
Bytes joined(std::uint32_t view, std::vector<ChunkEntry> entries) {
  return *join_entries(view, entries).bytes;
}

/// Returns a snapshot of so many runs.
ChunkEntry snapshot(std::int32_t x, std::uint32_t runs) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(32), kEmpty);
  for (std::uint32_t i = 1; i < runs; i += 2) fill(chunk.voxels, i, 1, 1);
  return encode_snapshot(key(x), chunk, ChunkEncoding::packed);
}

SendLimits limits() {
  SendLimits l;
  l.control_bytes = 100'000;
  l.edit_bytes = 1'000;
  l.chunk_bytes = 50'000;
  l.chunk_count = 4;
  return l;
}

/// Returns everything that the queue sends, as the client's reader gets it.
struct Wire {
  Bytes bytes;
  void take_all(SendQueue& queue) {
    SendQueue::Batch batch;
    while (queue.take(batch)) append(batch);
  }
  void append(const SendQueue::Batch& batch) {
    for (const auto& piece : batch.pieces) {
      bytes.insert(bytes.end(), piece.header.begin(), piece.header.end());
      bytes.insert(bytes.end(), piece.body.begin(), piece.body.end());
    }
  }
  std::vector<std::pair<FrameClass, Bytes>> messages() const {
    std::vector<std::pair<FrameClass, Bytes>> got;
    FrameReader reader(Sender::server);
    const auto fed = reader.feed(bytes, [&](MessageKind kind, ByteView body) -> Result<void> {
      got.emplace_back(info_of(kind).frame_class, Bytes(body.begin(), body.end()));
      return {};
    });
    REQUIRE(fed.has_value());
    return got;
  }
};

TEST_CASE("each class has its own bound and rejects messages beyond it", "[net]") {
  SendQueue queue(limits());
  CHECK(queue.push(message(FrameClass::edits, 600)));
  CHECK(queue.push(message(FrameClass::edits, 400)));
  CHECK_FALSE(queue.push(message(FrameClass::edits, 1)));
  CHECK(queue.push(message(FrameClass::control, 90'000)));
  CHECK_FALSE(queue.push(message(FrameClass::control, 10'001)));
  for (int i = 0; i < 4; ++i) CHECK(queue.reserve_chunk(key(i), 1).has_value());
  CHECK_FALSE(
      queue.reserve_chunk(key(4), 1).has_value());  // places count even before they are filled
}

TEST_CASE("each class has a maximal number of messages, also of small ones", "[net]") {
  SendLimits few = limits();
  few.control_count = 3;
  few.edit_count = 5;
  SendQueue queue(few);
  for (const auto& [c, count] :
       {std::pair{FrameClass::control, 3}, std::pair{FrameClass::edits, 5}}) {
    for (int i = 0; i < count; ++i) CHECK(queue.push(message(c, 8)));
    CHECK_FALSE(queue.push(message(c, 8)));
  }
  CHECK_FALSE(queue.take_drained());
  Wire wire;
  wire.take_all(queue);
  CHECK(wire.messages().size() == 8);
  CHECK(queue.take_drained());
  CHECK(queue.push(message(FrameClass::control, 8)));
}

TEST_CASE("small messages of the chunk class use places as chunks do", "[net]") {
  SendQueue queue(limits());
  CHECK(queue.reserve_chunk(key(0), 1).has_value());
  for (int i = 0; i < 3; ++i) CHECK(queue.push(message(FrameClass::chunks, 8)));
  CHECK_FALSE(queue.push(message(FrameClass::chunks, 8)));
  CHECK_FALSE(queue.reserve_chunk(key(0), 1).has_value());
  for (int i = 0; i < 10; ++i)
    CHECK(queue.push(message(FrameClass::edits, 8)));  // edits have their own places
}

TEST_CASE("a message larger than its bound still fits an empty class", "[net]") {
  SendQueue queue(limits());
  CHECK(queue.push(message(FrameClass::edits, 5'000)));
  CHECK_FALSE(queue.push(message(FrameClass::edits, 1)));
}

TEST_CASE("an edit overtakes terrain at the next fragment", "[net]") {
  SendQueue queue(limits());
  const auto place = queue.reserve_chunk(key(0), 1);
  queue.fill(*place, entry(0, 3 * kFragmentBytesMax));
  Wire wire;
  SendQueue::Batch batch;
  REQUIRE(queue.take(batch));
  CHECK(batch.pieces.size() == 1);  // one fragment of terrain per write
  wire.append(batch);
  CHECK(queue.push(message(FrameClass::control, 10)));
  CHECK(queue.push(message(FrameClass::edits, 10)));
  wire.take_all(queue);
  const auto got = wire.messages();
  REQUIRE(got.size() == 3);
  CHECK(got[0].first == FrameClass::edits);
  CHECK(got[1].first == FrameClass::control);
  CHECK(got[2].first == FrameClass::chunks);
  CHECK(got[2].second == joined(1, {entry(0, 3 * kFragmentBytesMax)}));
  CHECK(queue.empty());
}

TEST_CASE("terrain is sent only as allowed, in fragments of the allowed size", "[net]") {
  SendQueue queue(limits());
  const auto place = queue.reserve_chunk(key(0), 1);
  CHECK_FALSE(queue.has_chunk());
  queue.fill(*place, entry(0, 5'000));
  CHECK(queue.has_chunk());
  SendQueue::Batch batch;
  CHECK_FALSE(queue.take(batch, 0));
  CHECK(queue.push(message(FrameClass::edits, 10)));
  REQUIRE(queue.take(batch, 0));  // edits do not wait for it
  CHECK(batch.chunk_bytes == 0);
  REQUIRE(queue.take(batch, 2'000));
  CHECK(batch.chunk_bytes == 2'000 + kFrameHeaderBytes);
  CHECK(batch.bytes == batch.chunk_bytes);
}

TEST_CASE("terrain and control are not starved by endless edits", "[net]") {
  SendLimits wide;
  SendQueue queue(wide);
  const auto place = queue.reserve_chunk(key(0), 1);
  queue.fill(*place, entry(0, 3'000'000));
  SendQueue::Batch batch;
  std::size_t all = 0, chunks = 0, control = 0;
  for (int i = 0; i < 300; ++i) {
    while (queue.queued_bytes(FrameClass::edits) < 200'000)
      REQUIRE(queue.push(message(FrameClass::edits, 30'000)));
    while (queue.queued_bytes(FrameClass::control) < 50'000)
      REQUIRE(queue.push(message(FrameClass::control, 10'000)));
    REQUIRE(queue.take(batch));
    all += batch.bytes;
    chunks += batch.chunk_bytes;
    for (const auto& piece : batch.pieces) {
      const bool is_control = piece.header[2] == wire_number(kKindOf<PlayerPoses>);
      control += is_control ? piece.body.size() : 0;
    }
  }
  CHECK(chunks >= all / 8);
  CHECK(control >= all / 12);
  CHECK(chunks + control <= all / 2);  // edits still get the larger part
}

TEST_CASE("snapshots outside of the view are dropped, except one that has begun", "[net]") {
  SendQueue queue(limits());
  const View view{2, {0, 0, 0}, 2, 0};
  const auto begun = queue.reserve_chunk(key(50), 1);
  queue.fill(*begun, entry(50, 100, 1));
  SendQueue::Batch batch;
  Wire wire;
  REQUIRE(queue.take(batch, 60));
  wire.append(batch);
  const auto inside = queue.reserve_chunk(key(1), 1);
  const auto outside = queue.reserve_chunk(key(51), 1);
  const auto unfilled = queue.reserve_chunk(key(52), 1);
  queue.fill(*outside, entry(51, 2'000, 9));
  queue.forget_outside(view);
  queue.fill(*inside, entry(1, 10, 2));
  queue.fill(*unfilled, entry(52, 10, 9));
  CHECK(queue.push(message(FrameClass::chunks, 10, 3)));  // it is no snapshot, so it stays
  queue.forget_outside(view);
  CHECK(queue.queued_bytes(FrameClass::chunks) ==
        joined(1, {entry(50, 100)}).size() - 60 + 10 + 10);
  wire.take_all(queue);
  const auto got = wire.messages();
  REQUIRE(got.size() == 3);
  CHECK(got[0].second == joined(1, {entry(50, 100, 1)}));
  CHECK(got[1].second == joined(1, {entry(1, 10, 2)}));
  CHECK(got[2].second == Bytes(10, 3));
}

TEST_CASE("chunks that wait together are one message, ascending by key", "[net]") {
  SendLimits many;
  SendQueue queue(many);
  const auto put = [&queue](const ChunkEntry& chunk, std::uint32_t view) {
    const auto place = queue.reserve_chunk(chunk.key, view);
    REQUIRE(place);
    queue.fill(*place, chunk);
  };
  Wire wire;
  std::size_t seen = 0;
  const auto sent = [&] {
    wire.take_all(queue);
    const auto all = wire.messages();
    std::vector<Bytes> bodies;
    for (; seen < all.size(); ++seen) bodies.push_back(all[seen].second);
    return bodies;
  };
  SECTION("in any order of their places") {
    for (const std::int32_t x : {7, -3, 4}) put(entry(x, 100), 5);
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(-3, 100), entry(4, 100), entry(7, 100)})});
  }
  SECTION("but not if they answer different views") {
    put(entry(1, 10), 5);
    put(entry(2, 10), 6);
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(1, 10)}), joined(6, {entry(2, 10)})});
  }
  SECTION("but not around another message of the class") {
    put(entry(1, 10), 5);
    CHECK(queue.push(message(FrameClass::chunks, 10, 3)));
    put(entry(2, 10), 5);
    CHECK(sent() ==
          std::vector<Bytes>{joined(5, {entry(1, 10)}), Bytes(10, 3), joined(5, {entry(2, 10)})});
  }
  SECTION("but not past a chunk that is not encoded yet") {
    put(entry(1, 10), 5);
    const auto open = queue.reserve_chunk(key(2), 5);
    put(entry(3, 10), 5);
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(1, 10)})});
    queue.fill(*open, entry(2, 10));
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(2, 10), entry(3, 10)})});
  }
  SECTION("and a chunk that is due twice is sent twice, in order") {
    put(entry(1, 10, 1), 5);
    put(entry(1, 10, 2), 5);
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(1, 10, 1)}), joined(5, {entry(1, 10, 2)})});
  }
  SECTION("of about four KiB, so that the first chunks are shown soon") {
    for (std::int32_t x = 0; x < 5; ++x) put(entry(x, 1'500), 5);
    CHECK(sent() == std::vector<Bytes>{joined(5, {entry(0, 1'500), entry(1, 1'500)}),
                                       joined(5, {entry(2, 1'500), entry(3, 1'500)}),
                                       joined(5, {entry(4, 1'500)})});
  }
  SECTION("and a reader accepts them, however many runs they have") {
    for (std::int32_t x = 0; x < 6; ++x) put(snapshot(x, 32'000), 5);
    std::size_t chunks = 0;
    for (const Bytes& body : sent()) {
      const auto message = decode_message(Sender::server, kKindOf<Chunks>, body, 32);
      REQUIRE(message);
      chunks += std::get<Chunks>(*message).chunks.size();
    }
    CHECK(chunks == 6);
  }
}

TEST_CASE("a smaller backlog lets fewer bytes of chunks wait", "[net]") {
  SendQueue queue(limits());
  queue.set_chunk_backlog(5'000);
  const auto first = queue.reserve_chunk(key(0), 1);
  queue.fill(*first, entry(0, 6'000));
  CHECK_FALSE(queue.reserve_chunk(key(0), 1).has_value());
  SendQueue::Batch batch;
  REQUIRE(queue.take(batch, 2'000));
  CHECK_FALSE(queue.take_drained());
  REQUIRE(queue.take(batch, 2'000));
  CHECK(queue.take_drained());
  CHECK(queue.reserve_chunk(key(0), 1).has_value());
}

TEST_CASE("chunks keep the order of their places, however late they are filled", "[net]") {
  SendQueue queue(limits());
  const auto first = queue.reserve_chunk(key(0), 1);
  const auto second = queue.reserve_chunk(key(0), 1);
  queue.fill(*second, entry(0, 10, 2));
  SendQueue::Batch batch;
  CHECK_FALSE(queue.take(batch));
  queue.fill(*first, entry(0, 10, 1));
  Wire wire;
  wire.take_all(queue);
  const auto got = wire.messages();
  REQUIRE(got.size() == 2);
  CHECK(got[0].second == joined(1, {entry(0, 10, 1)}));
  CHECK(got[1].second == joined(1, {entry(0, 10, 2)}));
}

TEST_CASE("after a refused message the queue reports once that it has room again", "[net]") {
  SendQueue queue(limits());
  SendQueue::Batch batch;
  CHECK_FALSE(queue.take_drained());
  REQUIRE(queue.push(message(FrameClass::edits, 1'000)));
  REQUIRE_FALSE(queue.push(message(FrameClass::edits, 1)));
  CHECK_FALSE(queue.take_drained());
  REQUIRE(queue.take(batch));
  CHECK(queue.take_drained());
  CHECK_FALSE(queue.take_drained());
}

TEST_CASE("dropped chunks are not sent, and filling their places does nothing", "[net]") {
  SendQueue queue(limits());
  const auto sent_in_part = queue.reserve_chunk(key(0), 1);
  queue.fill(*sent_in_part, entry(0, 2 * kFragmentBytesMax));
  SendQueue::Batch batch;
  REQUIRE(queue.take(batch));
  const auto open = queue.reserve_chunk(key(0), 1);
  queue.drop_chunks();
  queue.fill(*open, entry(0, 10));
  CHECK(queue.empty());
  CHECK_FALSE(queue.take(batch));
  CHECK(queue.queued_bytes(FrameClass::chunks) == 0);
}

TEST_CASE("messages of any mix arrive complete and in order within their class",
          "[net][property]") {
  SplitMix64 rng(Catch::rngSeed());
  SendLimits wide;
  wide.chunk_count = 1000;
  SendQueue queue(wide);
  Wire wire;
  std::map<FrameClass, std::vector<Bytes>> sent;
  std::vector<ChunkKey> sent_chunks;
  std::vector<std::pair<ChunkPlace, ChunkEntry>> unfilled;
  SendQueue::Batch batch;
  for (int step = 0; step < 400; ++step) {
    const auto size = 1 + rng.below(rng.below(4) == 0 ? 60'000 : 200);
    switch (rng.below(4)) {
      case 0:
      case 1: {
        const auto frame_class = rng.below(2) == 0 ? FrameClass::edits : FrameClass::control;
        const auto m = message(frame_class, size, static_cast<std::uint8_t>(rng.next()));
        if (queue.push(m)) sent[frame_class].push_back(*m.bytes);
        break;
      }
      case 2: {
        // Keys ascend, so that a message keeps the order of the places.
        const auto x = static_cast<std::int32_t>(sent_chunks.size());
        if (const auto place = queue.reserve_chunk(key(x), 1 + rng.below(2))) {
          sent_chunks.push_back(key(x));
          unfilled.emplace_back(*place, snapshot(x, 1 + rng.below(rng.below(4) == 0 ? 30'000 : 9)));
        }
        break;
      }
      default:
        if (!unfilled.empty()) {
          const auto at = rng.below(static_cast<std::uint32_t>(unfilled.size()));
          queue.fill(unfilled[at].first, unfilled[at].second);
          unfilled.erase(unfilled.begin() + at);
        }
        if (queue.take(batch)) {
          CHECK(batch.bytes < wide.write_bytes + kFragmentBytesMax + kFrameHeaderBytes);
          wire.append(batch);
        }
    }
  }
  for (const auto& [place, m] : unfilled) queue.fill(place, m);
  wire.take_all(queue);
  std::map<FrameClass, std::vector<Bytes>> got;
  std::vector<ChunkKey> got_chunks;
  for (auto& [frame_class, bytes] : wire.messages()) {
    if (frame_class != FrameClass::chunks) {
      got[frame_class].push_back(std::move(bytes));
      continue;
    }
    const auto message = decode_message(Sender::server, kKindOf<Chunks>, bytes, 32);
    REQUIRE(message);
    for (const ChunkAnswer& answer : std::get<Chunks>(*message).chunks)
      got_chunks.push_back(key_of(answer));
  }
  CHECK(got == sent);
  CHECK(got_chunks == sent_chunks);
  CHECK(queue.empty());
  for (const auto c : {FrameClass::control, FrameClass::edits, FrameClass::chunks})
    CHECK(queue.queued_bytes(c) == 0);
}

}  // namespace
}  // namespace runstone
