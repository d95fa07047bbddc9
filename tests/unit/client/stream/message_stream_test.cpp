#include "client/stream/message_stream.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace runstone;

namespace {

std::int64_t clock_ns() { return 7'000; }

struct StreamBench final : MessageSink {
  void on_received(LinkReceived message) override { received.push_back(std::move(message)); }

  /// Returns the frames in which the server sends a message.
  Bytes from_server(const Message& message) {
    Bytes out;
    server.append(encode_message(message), out);
    return out;
  }
  void open(std::uint64_t features) {
    Welcome welcome;
    welcome.epoch = 1;
    welcome.chunk_edge = 16;
    welcome.features = features;
    welcome.materials = default_material_table();
    REQUIRE(stream.receive(from_server(welcome), 1).has_value());
  }
  /// Returns what the client would send, as the server reads it.
  std::vector<Message> sent() {
    Bytes out;
    stream.write(out, SIZE_MAX);
    std::vector<Message> messages;
    const auto read = reader.feed(out, [&](MessageKind kind, ByteView body) -> Result<void> {
      auto message = decode_message(Sender::client, kind, body, 16);
      REQUIRE(message.has_value());
      messages.push_back(*std::move(message));
      return {};
    });
    REQUIRE(read.has_value());
    return messages;
  }

  LinkStats stats;
  std::vector<LinkReceived> received;
  MessageStream stream{3, stats, *this, clock_ns};
  FrameWriter server;
  FrameReader reader{Sender::client};
};

}  // namespace

TEST_CASE("messages are the same however their bytes arrive", "[client_net]") {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{1} << 20}) {
    StreamBench bench;
    bench.open(0);
    bench.received.clear();
    Bytes bytes = bench.from_server(Pong{11, 22});
    const Bytes more = bench.from_server(Goodbye{GoodbyeReason::closing, "bye"});
    bytes.insert(bytes.end(), more.begin(), more.end());
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      const std::size_t size = std::min(piece, bytes.size() - at);
      REQUIRE(bench.stream.receive(ByteView(bytes).subspan(at, size), 5).has_value());
    }
    REQUIRE(bench.received.size() == 2);
    CHECK(bench.received[0].connection == 3);
    CHECK(bench.received[0].received_us == 5);
    CHECK(bench.received[0].unpacked_us == 7);
    CHECK(std::get<Pong>(bench.received[0].message).sent_us == 11);
    CHECK(std::get<Goodbye>(bench.received[1].message).text == "bye");
  }
}

TEST_CASE("each flipped bit of a header ends the stream or changes nothing else", "[client_net]") {
  for (std::size_t bit = 0; bit < 8 * kFrameHeaderBytes; ++bit) {
    StreamBench bench;
    bench.open(0);
    bench.received.clear();
    // As a Resume, whose kind differs by one bit, it would have a sequence out of range.
    Bytes bytes = bench.from_server(Pong{-11, 22});
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
    const auto read = bench.stream.receive(bytes, 5);
    CAPTURE(bit);
    CHECK(bench.received.empty());  // it is refused, or the rest of the frame is waited for
    if (!read) CHECK_FALSE(bench.stream.receive(bench.from_server(Pong{1, 2}), 5).has_value());
  }
}

TEST_CASE("edits are written before what was queued earlier", "[client_net]") {
  StreamBench bench;
  REQUIRE(bench.stream.queue(encode_message(Ping{1})));
  EditRequest edit;
  edit.client_seq = 9;
  edit.edit = {SetVoxel{{1, 2, 3}}, {}, 1};
  REQUIRE(bench.stream.queue(encode_message(edit)));
  CHECK(bench.stream.has_output());
  const auto sent = bench.sent();
  REQUIRE(sent.size() == 2);
  CHECK(std::holds_alternative<EditRequest>(sent[0]));
  CHECK(std::holds_alternative<Ping>(sent[1]));
  CHECK_FALSE(bench.stream.has_output());
}

TEST_CASE("a queue that is full takes no more, and is empty after writing", "[client_net]") {
  StreamBench bench;
  const EncodedMessage message = encode_message(ChatRequest{std::string(kChatBytesMax, 'x')});
  std::size_t queued = 0;
  while (bench.stream.queue(message)) ++queued;
  CHECK(queued == kSendBytesMax / message.bytes->size());
  CHECK(bench.sent().size() == queued);
}

TEST_CASE("chunk bytes are acknowledged only to servers that want it", "[client_net]") {
  for (const std::uint64_t features : {std::uint64_t{0}, kFeatureReceiveAck}) {
    StreamBench bench;
    bench.open(features);
    CHECK_FALSE(bench.stream.acknowledge(1'000).has_value());  // nothing was read yet
    Chunks chunks;
    chunks.view = 1;
    ChunkSnapshot snapshot;
    snapshot.key = {0, {0, 0, 0}};
    snapshot.chunk.voxels = uniform_chunk(Extent::cube(16), kEmpty);
    chunks.chunks.emplace_back(snapshot);
    const Bytes bytes = bench.from_server(chunks);
    REQUIRE(bench.stream.receive(bytes, 2).has_value());
    static_cast<void>(bench.stream.acknowledge(2'000));
    const auto sent = bench.sent();
    REQUIRE(sent.size() == (features == 0 ? 0U : 1U));
    if (features != 0) CHECK(std::get<ReceiveAck>(sent[0]).chunk_bytes == bytes.size());
    CHECK_FALSE(bench.stream.acknowledge(1'000'000).has_value());  // all of it is acknowledged
  }
}
