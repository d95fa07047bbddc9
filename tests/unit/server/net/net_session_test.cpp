#include "server/net/net_session.hpp"

#include <algorithm>
#include <asio/experimental/as_tuple.hpp>
#include <asio/post.hpp>
#include <asio/use_awaitable.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/os/steady_clock.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/net/send_round.hpp"
#include "tests/support/edits/hostile_edits.hpp"

using namespace runstone;

namespace {

constexpr auto kTuple = asio::experimental::as_tuple(asio::use_awaitable);

/// A client that has sent all its bytes and accepts every write, whatever the room.
class FedStream final : public ByteStream {
 public:
  FedStream(asio::io_context& io, Bytes bytes) : bytes_(std::move(bytes)), closed_(io) {
    closed_.expires_at(asio::steady_timer::time_point::max());
  }
  asio::awaitable<StreamStart> open() override {
    if (start == StreamStart::open) co_return start;
    const auto [error] = co_await closed_.async_wait(kTuple);
    (void)error;  // cancelled when the stream is closed
    co_return start;
  }
  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override {
    while (!is_closed_ && at_ == bytes_.size()) {
      const auto [error] = co_await closed_.async_wait(kTuple);
      (void)error;  // cancelled at the end, or by feed()
    }
    if (is_closed_) co_return IoResult{asio::error::operation_aborted};
    const std::size_t count = std::min(into.size(), bytes_.size() - at_);
    std::memcpy(into.data(), bytes_.data() + at_, count);
    at_ += count;
    co_return IoResult{{}, count, count};
  }
  IoResult write_now(std::span<const asio::const_buffer> buffers,
                     std::size_t /*terrain_bytes*/) override {
    IoResult result;
    result.error = write_error;
    result.has_rest = reads_nothing;
    if (reads_nothing || write_error) return result;
    result.bytes = std::min(taken_at_once, asio::buffer_size(buffers));
    result.has_rest = result.bytes < asio::buffer_size(buffers);
    std::size_t left = result.bytes;
    rest_.clear();
    for (const asio::const_buffer& buffer : buffers) {
      const std::size_t taken = std::min(left, buffer.size());
      take(asio::buffer(buffer, taken));
      rest_.push_back(buffer + taken);
      left -= taken;
    }
    return result;
  }
  asio::awaitable<IoResult> write_rest() override {
    if (reads_nothing) {
      const auto [error] = co_await closed_.async_wait(kTuple);
      (void)error;  // cancelled when the stream is closed
      co_return IoResult{asio::error::operation_aborted};
    }
    // The peer reads later.
    co_await asio::post(asio::use_awaitable);
    IoResult result;
    for (const asio::const_buffer& buffer : rest_) {
      take(buffer);
      result.bytes += buffer.size();
    }
    co_return result;
  }
  StreamRoom room() override {
    ++asked;
    return room_now;
  }
  /// Sends more bytes.
  void feed(const Bytes& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    closed_.cancel();
  }
  void shutdown_send() override {}
  void close() override {
    is_closed_ = true;
    closed_.cancel();
  }
  std::string peer() const override { return "test"; }
  std::size_t read() const { return at_; }
  bool reads_nothing = false;             // a write waits until the stream is closed
  StreamStart start = StreamStart::open;  // otherwise open() waits until the stream is closed
  StreamRoom room_now;
  std::size_t asked = 0;
  Bytes written;
  std::size_t taken_at_once = SIZE_MAX;  // of each write, the rest later
  asio::error_code write_error;

 private:
  void take(asio::const_buffer buffer) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer.data());
    written.insert(written.end(), bytes, bytes + buffer.size());
  }

  std::vector<asio::const_buffer> rest_;
  Bytes bytes_;
  std::size_t at_ = 0;
  bool is_closed_ = false;
  asio::steady_timer closed_;
};

/// Keeps messages unhandled until the test handles them.
struct SlowWorld final : NetEvents {
  void on_refused(SessionId /*session*/) override { is_refused = true; }
  void on_connected(SessionId /*session*/,
                    const std::optional<ChannelBinding>& /*binding*/) override {
    is_connected = true;
  }
  void on_message(SessionId /*session*/, Message&& /*message*/, std::size_t bytes) override {
    waiting.push_back(bytes);
    most = std::max(most, waiting.size());
    ++received;
  }
  void on_drained(SessionId /*session*/) override {}
  void on_disconnected(SessionId /*session*/) override { is_disconnected = true; }
  std::vector<std::size_t> waiting;
  std::size_t received = 0, most = 0;
  bool is_connected = false, is_disconnected = false, is_refused = false;
};

Bytes frames_of(const Message& message, std::size_t count) {
  const EncodedMessage encoded = encode_message(message);
  FrameWriter frames;
  Bytes out;
  for (std::size_t i = 0; i < count; ++i) frames.append(encoded, out);
  return out;
}

struct Bench {
  explicit Bench(Bytes received = {}, StreamRoom room = {}, const NetLimits& limits_ = {},
                 StreamStart start = StreamStart::open)
      : limits(limits_) {
    auto fed = std::make_unique<FedStream>(io, std::move(received));
    fed->room_now = room;
    fed->start = start;
    stream = fed.get();
    session = std::make_shared<NetSession>(
        SessionId{1}, io, decoders.get_executor(), std::move(fed), limits, std::uint16_t{32},
        budget, std::make_shared<ByteBudget>(limits.read_bytes_per_address), world, counters);
    session->start();
    io.poll();
  }
  ~Bench() {
    session->abort();
    while (!io.stopped()) {
      decoders.restart();
      decoders.poll();
      io.run_for(std::chrono::milliseconds(1));
    }
  }
  /// Returns the bytes of bodies that the client got, of chunks and of edits.
  std::pair<std::size_t, std::size_t> sent() const {
    std::size_t chunks = 0, edits = 0;
    for (std::size_t at = 0; at < stream->written.size();) {
      const std::uint8_t* header = stream->written.data() + at;  // length, little-endian; kind
      const std::size_t body_bytes = header[0] + 256U * header[1];
      (header[2] == wire_number(kKindOf<Chunks>) ? chunks : edits) += body_bytes;
      at += kFrameHeaderBytes + body_bytes;
    }
    return {chunks, edits};
  }
  /// Queues a chunk and returns the bytes of its message.
  std::size_t fill_chunk(std::size_t bytes) {
    const ChunkEntry chunk{{0, {0, 0, 0}}, std::make_shared<const Bytes>(bytes), 1};
    const auto place = session->reserve_chunk(chunk.key, 1);
    REQUIRE(place);
    session->fill_chunk(*place, chunk);
    io.poll();
    return join_entries(1, {&chunk, 1}).bytes->size();
  }
  void edit(std::size_t bytes) {
    REQUIRE(session->send({kKindOf<Commit>, std::make_shared<const Bytes>(bytes)}));
    io.poll();
  }
  asio::io_context io, decoders;
  const NetLimits limits;
  ByteBudget budget{0};
  NetCounters counters;
  SlowWorld world;
  FedStream* stream = nullptr;
  std::shared_ptr<NetSession> session;
};

}  // namespace

TEST_CASE("a session has few unhandled messages, fewer large ones than small ones", "[net]") {
  ChunkRequest request;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(kChunkRequestKeysMax); ++i) {
    request.keys.push_back({0, {i, 0, 0}});
  }
  const bool is_large = GENERATE(true, false);
  CAPTURE(is_large);
  constexpr std::size_t kCount = 1'000;
  Bench bench(frames_of(is_large ? Message(request) : Message(Ping{1}), kCount));
  const std::size_t size = bench.world.waiting.at(0);
  constexpr std::size_t kBoundBytes = 8 * 1024, kReadBytes = 4 * 1024, kMessageBytes = 64;
  const std::size_t in_bound = kBoundBytes / (size + kMessageBytes) + 1;
  const std::size_t in_read = kReadBytes / (size + kFrameHeaderBytes) + 1;
  CHECK(bench.world.received >= in_bound);
  CHECK(bench.world.received <= in_bound + in_read);
  CHECK(bench.stream->read() <= kBoundBytes + 2 * kReadBytes);
  while (bench.world.received < kCount) {
    const auto waiting = std::exchange(bench.world.waiting, {});
    REQUIRE_FALSE(waiting.empty());
    for (const std::size_t bytes : waiting) bench.session->handled(bytes);
    bench.io.poll();
    REQUIRE_FALSE(bench.world.is_disconnected);
  }
  CHECK(bench.world.most <= in_bound + in_read);
}

TEST_CASE("a connection whose handshake does not end is closed, and nobody hears of it", "[net]") {
  NetLimits limits;
  limits.handshake_ms = 5;
  Bench bench({}, {}, limits, StreamStart::failed);
  CHECK_FALSE(bench.world.is_refused);
  while (!bench.world.is_refused) REQUIRE(bench.io.run_one() == 1);
  CHECK_FALSE(bench.world.is_connected);
  CHECK_FALSE(bench.world.is_disconnected);
}

TEST_CASE("closing a session during its handshake closes the connection at once", "[net]") {
  Bench bench({}, {}, {}, StreamStart::failed);
  bench.session->close(GoodbyeReason::closing, "the server stops");
  bench.io.poll();
  CHECK(bench.world.is_refused);
  CHECK_FALSE(bench.world.is_connected);
}

TEST_CASE("a large message is decoded by the decoders, and small ones are not", "[net]") {
  Bench small(frames_of(Ping{1}, 10));
  CHECK(small.world.received == 10);

  const EditRequest paste{1, 0, {Paste{{0, 0, 0}, test::long_clipboard(), {}}, {}, kEmpty}};
  Bench large(frames_of(paste, 1));
  CHECK(large.world.received == 0);
  for (int i = 0; i < 100 && large.world.received == 0; ++i) {
    large.decoders.poll();
    large.decoders.restart();
    large.io.poll();
  }
  CHECK(large.world.received == 1);
}

TEST_CASE("each message counts as read with more than its bytes", "[net]") {
  NetLimits limits;
  limits.read_bytes_per_second = 250'000;  // twice as much at once
  limits.unhandled_bytes_max = 1'000'000;
  Bench bench(frames_of(Ping{1}, 2'000), {}, limits);
  CHECK(bench.world.received >= 900);
  CHECK(bench.world.received < 1'500);
}

TEST_CASE("after a broken rule or a goodbye little more is read", "[net]") {
  const bool is_goodbye = GENERATE(true, false);
  CAPTURE(is_goodbye);
  Bench bench(is_goodbye ? frames_of(Goodbye{GoodbyeReason::closing, "bye"}, 1) : Bytes());
  if (!is_goodbye) bench.session->close(GoodbyeReason::unexpected_message, "");
  const std::size_t before = bench.stream->read();
  bench.stream->feed(frames_of(Ping{1}, 20'000));
  bench.io.poll();
  CHECK(bench.stream->read() - before >= 64 * 1024);
  CHECK(bench.stream->read() - before <= 72 * 1024);
  CHECK(bench.world.received == (is_goodbye ? 1 : 0));
}

TEST_CASE("how much is read of a session that is being closed", "[net]") {
  struct Case {
    bool is_authenticated;
    GoodbyeReason reason;
    bool reads_on;
  };
  const auto [is_authenticated, reason, reads_on] = GENERATE(
      Case{true, GoodbyeReason::closing, true}, Case{true, GoodbyeReason::not_admitted, true},
      Case{true, GoodbyeReason::flooding, false}, Case{false, GoodbyeReason::not_admitted, false});
  CAPTURE(is_authenticated, reason);
  Bench bench;
  if (is_authenticated) bench.session->authenticated();
  bench.session->close(reason, "");
  const std::size_t before = bench.stream->read();
  bench.stream->feed(frames_of(Ping{1}, 20'000));
  bench.io.poll();
  const std::size_t read = bench.stream->read() - before;
  CHECK(read >= 64 * 1024);
  CHECK((read > 72 * 1024) == reads_on);
}

TEST_CASE("acknowledgements of terrain count as read with more than their bytes", "[net]") {
  NetLimits limits;
  limits.read_bytes_per_second = 250'000;  // twice as much at once
  limits.messages_per_second = 0;
  Bench bench({}, {}, limits);
  bench.session->set_features(kFeatureReceiveAck);
  bench.fill_chunk(50'000);
  bench.stream->feed(frames_of(ReceiveAck{1}, 10'000));
  bench.io.poll();
  CHECK(bench.counters.messages_in >= 1'500);
  CHECK(bench.counters.messages_in < 2'200);
}

TEST_CASE("an address has a budget of reading, too", "[net]") {
  NetLimits limits;
  limits.read_bytes_per_address = 250'000;  // twice as much at once
  limits.unhandled_bytes_max = 1'000'000;
  Bench bench(frames_of(Ping{1}, 2'000), {}, limits);
  CHECK(bench.world.received >= 900);
  CHECK(bench.world.received < 1'500);
}

TEST_CASE("without room in the socket edits are sent, and terrain waits with growing pauses",
          "[net]") {
  Bench bench({}, {0, 1'000});
  const std::size_t terrain = bench.fill_chunk(5'000);
  bench.edit(100);
  CHECK(bench.sent() == std::pair<std::size_t, std::size_t>{0, 100});
  // The last pauses are 4, 8, 16 and 32 ms. A slow machine makes them longer, never shorter.
  const auto began = std::chrono::steady_clock::now();
  for (const std::size_t asked = bench.stream->asked; bench.stream->asked < asked + 5;)
    bench.io.run_one();
  CHECK(std::chrono::steady_clock::now() - began >= std::chrono::milliseconds(50));
  CHECK(bench.sent() == std::pair<std::size_t, std::size_t>{0, 100});
  bench.stream->room_now = {2'000, 0};
  while (bench.sent().first < terrain) REQUIRE(bench.io.run_one() == 1);
  CHECK(bench.sent() == std::pair<std::size_t, std::size_t>{terrain, 100});
}

TEST_CASE("edits that never leave room do not starve terrain", "[net]") {
  Bench bench({}, {0, 1'000});
  bench.fill_chunk(50'000);
  for (int i = 0; i < 100; ++i) bench.edit(10'000);
  const auto [chunks, edits] = bench.sent();
  CHECK(edits == 1'000'000);
  CHECK(chunks >= 20'000);  // 2 KiB for each 64 KiB
  CHECK(chunks <= 40'000);
}

TEST_CASE("a session says for how long its client has read nothing", "[net]") {
  Bench bench;
  constexpr TimeUs kLater = 60'000'000;
  bench.edit(100);
  CHECK(bench.session->write_us(steady_now_us() + kLater) == 0);  // the write has ended
  bench.stream->reads_nothing = true;
  bench.edit(100);
  const TimeUs waited = bench.session->write_us(steady_now_us() + kLater);
  CHECK(waited >= kLater);
  CHECK(waited < 2 * kLater);
}

TEST_CASE("what a socket does not take at once follows in order", "[net]") {
  Bench bench;
  for (const std::size_t at_once : {std::size_t{0}, std::size_t{1}, std::size_t{10}, SIZE_MAX}) {
    bench.stream->written.clear();
    bench.stream->taken_at_once = at_once;
    for (int i = 0; i < 50; ++i) {
      REQUIRE(bench.session->send({kKindOf<Commit>, std::make_shared<const Bytes>(100 + i)}));
      if (i % 5 == 0) bench.io.poll();
    }
    bench.io.poll();
    const Bytes& written = bench.stream->written;
    std::size_t at = 0;
    for (std::size_t i = 0; i < 50; ++i) {
      REQUIRE(at + kFrameHeaderBytes + 100 + i <= written.size());
      CHECK(written[at] == 100 + i);  // length, little-endian
      at += kFrameHeaderBytes + 100 + i;
    }
    CHECK(at == written.size());
    CHECK(bench.counters.bytes_out >= written.size());
    CHECK(bench.counters.commits_due == 0);
    CHECK(bench.session->write_us(steady_now_us()) == 0);
  }
}

TEST_CASE("a write that fails at once ends the session", "[net]") {
  Bench bench;
  bench.stream->write_error = asio::error::connection_reset;
  bench.edit(100);
  CHECK(bench.session->end().text == "write failed");
  CHECK(bench.stream->written.empty());
}

TEST_CASE("a goodbye stands behind what was queued before it", "[net]") {
  Bench bench;
  REQUIRE(bench.session->send({kKindOf<Commit>, std::make_shared<const Bytes>(100)}));
  bench.session->close(GoodbyeReason::closing, "bye");
  bench.io.poll();
  REQUIRE(bench.stream->written.size() > 2 * kFrameHeaderBytes + 100);
  CHECK(bench.stream->written[2] == wire_number(kKindOf<Commit>));
  CHECK(bench.stream->written[kFrameHeaderBytes + 100 + 2] == wire_number(kKindOf<Goodbye>));
}

TEST_CASE("a round writes for all of its sessions, each message once", "[net]") {
  constexpr std::size_t kSessions = 70;  // more than two groups
  constexpr int kRounds = 3;
  std::vector<std::unique_ptr<Bench>> benches;
  asio::io_context io;
  NetCounters counters;
  for (std::size_t i = 0; i < kSessions; ++i) benches.push_back(std::make_unique<Bench>());
  for (int r = 0; r < kRounds; ++r) {
    SendRound round(io, counters, true);
    for (const auto& bench : benches)
      CHECK(bench->session->send({kKindOf<Commit>, std::make_shared<const Bytes>(100)}, round));
  }
  io.poll();
  for (const auto& bench : benches) {
    bench->io.poll();
    CHECK(bench->sent() == std::pair<std::size_t, std::size_t>{0, kRounds * 100});
  }
  CHECK(counters.commit_sends <= kSessions * kRounds);
}

TEST_CASE("a session that is trusted reads at any rate, also behind a goodbye", "[net]") {
  NetLimits limits;
  limits.messages_per_second = 1;
  limits.message_burst = 10;
  limits.read_bytes_per_second = limits.read_bytes_per_address = 1'000;
  Bench bench({}, {}, limits);
  bench.session->trust();
  bench.stream->feed(frames_of(Ping{1}, 20'000));
  bench.io.poll();
  CHECK(bench.world.received == 20'000);
  CHECK(bench.world.most == 20'000);

  Bench leaving(frames_of(Goodbye{GoodbyeReason::closing, "bye"}, 1));
  leaving.session->trust();
  Bytes behind = frames_of(Ping{1}, 1'001);
  behind.erase(behind.begin(), behind.begin() + static_cast<std::ptrdiff_t>(behind.size() / 1'001));
  leaving.stream->feed(behind);  // its first counter is 1
  leaving.io.poll();
  CHECK(leaving.world.received == 1'001);
}

TEST_CASE("a session that pauses reads on when it is trusted", "[net]") {
  Bench bench(frames_of(Ping{1}, 2'000));
  CHECK(bench.world.received < 1'000);
  bench.session->trust();
  bench.io.poll();
  CHECK(bench.world.received == 2'000);
}
