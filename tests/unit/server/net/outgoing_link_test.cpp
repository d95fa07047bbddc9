#include "server/net/outgoing_link.hpp"

#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/message_table.hpp"
#include "server/net/listener.hpp"

using namespace runstone;
using asio::ip::tcp;
using std::chrono::milliseconds;

namespace {

constexpr std::uint16_t kChunkEdge = 32;
constexpr milliseconds kLinkTime{10'000};

/// The server to which a link connects. It keeps what it gets.
struct LinkedServer final : NetEvents {
  LinkedServer(asio::io_context& io, bool is_encrypted)
      : listener(
            std::make_shared<Listener>(io, io.get_executor(), NetLimits{}, kChunkEdge, *this)) {
    constexpr std::array<std::uint8_t, 32> kSeed{1, 2, 3};
    if (is_encrypted) listener->set_tls(TlsContext::self_signed_server(kSeed));
    REQUIRE(listener->listen("127.0.0.1:0").has_value());
    listener->start();
  }
  void on_refused(SessionId session) override { listener->forget(session); }
  void on_connected(SessionId session, const std::optional<ChannelBinding>& with) override {
    binding = with;
    peer = listener->find(session);
  }
  void on_message(SessionId session, Message&& message, std::size_t bytes) override {
    messages.push_back(std::move(message));
    listener->find(session)->handled(bytes);
  }
  void on_drained(SessionId /*session*/) override {}
  void on_disconnected(SessionId session) override {
    listener->forget(session);
    is_disconnected = true;
  }
  std::shared_ptr<Listener> listener;
  std::shared_ptr<NetSession> peer;  // the last one that connected
  std::optional<ChannelBinding> binding;
  std::vector<Message> messages;
  bool is_disconnected = false;
};

/// A link, and what it has reported.
struct LinkBench {
  explicit LinkBench(std::optional<TlsContext> tls = std::nullopt) {
    OutgoingLink::Events events;
    events.on_connected = [this](const std::optional<ChannelBinding>& with) {
      CHECK_FALSE(is_connected);
      is_connected = true;
      binding = with;
    };
    events.on_message = [this](Message&& message, std::size_t bytes) {
      CHECK(ended.empty());
      waiting.push_back(bytes);
      messages.push_back(std::move(message));
      if (is_quick) handle_all();
    };
    events.on_ended = [this](const std::string& why) { ended.push_back(why); };
    link = std::make_shared<OutgoingLink>(io, io.get_executor(), kChunkEdge, std::move(tls),
                                          std::move(events));
  }
  ~LinkBench() {
    if (server) {
      server->listener->stop();
      server->listener->close_all(GoodbyeReason::closing, "the test ends");
    }
    link->close("the test ends");
    io.restart();
    io.run();
  }
  void serve(bool is_encrypted) { server.emplace(io, is_encrypted); }
  void connect(milliseconds time = kLinkTime) { connect_to("127.0.0.1", time); }
  void connect_to(const std::string& host, milliseconds time = kLinkTime) {
    link->connect({host, server->listener->port()}, time);
  }
  /// Connects to a server that is not one of ours.
  void connect(const tcp::acceptor& acceptor, milliseconds time = kLinkTime) {
    link->connect({"127.0.0.1", acceptor.local_endpoint().port()}, time);
  }
  /// Connects to it, and returns the other end.
  tcp::socket connect_and_accept(tcp::acceptor& acceptor) {
    connect(acceptor);
    run_until([this] { return is_connected; });
    return acceptor.accept();
  }
  template <class IsDone>
  void run_until(const IsDone& is_done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!is_done()) {
      REQUIRE(std::chrono::steady_clock::now() < deadline);
      io.restart();
      io.run_one_for(milliseconds(100));
    }
  }
  void run_until_connected() {
    run_until([this] { return is_connected && server->peer != nullptr; });
  }
  /// Returns why the link has ended.
  std::string run_until_ended() {
    run_until([this] { return !ended.empty(); });
    io.restart();
    io.poll();
    CHECK(ended.size() == 1);
    return ended.front();
  }
  void run_for(milliseconds time) {
    io.restart();
    io.run_for(time);
  }
  void handle_all() {
    for (const std::size_t bytes : std::exchange(waiting, {})) link->handled(bytes);
  }
  asio::io_context io;
  std::shared_ptr<OutgoingLink> link;
  std::optional<LinkedServer> server;
  bool is_connected = false, is_quick = true;
  std::optional<ChannelBinding> binding;
  std::vector<Message> messages;
  std::vector<std::size_t> waiting;  // bytes of messages that were not handled
  std::vector<std::string> ended;
};

std::optional<TlsContext> link_tls(bool is_encrypted) {
  return is_encrypted ? std::optional(TlsContext::client()) : std::nullopt;
}

Hello hello_of_server() {
  Hello hello;
  hello.instance = 1;
  hello.name = "server";
  return hello;
}

/// A server that is not one of ours.
tcp::acceptor listen_on(asio::io_context& io) {
  return {io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
}

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

TEST_CASE("a link and a server exchange messages over one binding", "[net]") {
  const bool is_encrypted = GENERATE(true, false);
  const std::string host = GENERATE("127.0.0.1", "localhost");
  CAPTURE(is_encrypted, host);
  LinkBench bench(link_tls(is_encrypted));
  bench.serve(is_encrypted);
  CHECK_FALSE(bench.link->send(encode_message(hello_of_server())));
  bench.connect_to(host);
  CHECK_FALSE(bench.link->send(encode_message(hello_of_server())));
  bench.run_until_connected();
  CHECK(bench.binding.has_value() == is_encrypted);
  CHECK(bench.binding == bench.server->binding);

  CHECK(bench.link->send(encode_message(hello_of_server())));
  bench.run_until([&] { return !bench.server->messages.empty(); });
  CHECK(bench.server->messages == std::vector<Message>{hello_of_server()});
  const Durable durable{1, 7, false};
  CHECK(bench.server->peer->send(encode_message(durable)));
  bench.run_until([&] { return !bench.messages.empty(); });
  CHECK(bench.messages == std::vector<Message>{durable});

  bench.link->close("this server takes over");
  CHECK(bench.run_until_ended() == "this server takes over");
  bench.run_until([&] { return bench.server->is_disconnected; });
  CHECK(bench.server->messages.back() ==
        Message(Goodbye{GoodbyeReason::closing, "this server takes over"}));
  CHECK(bench.link->send(encode_message(hello_of_server())));  // dropped
}

TEST_CASE("a link ends with the goodbye of the server", "[net]") {
  const bool is_encrypted = GENERATE(true, false);
  LinkBench bench(link_tls(is_encrypted));
  bench.serve(is_encrypted);
  bench.connect();
  bench.run_until_connected();
  bench.server->listener->close_all(GoodbyeReason::closing, "the server stops");
  CHECK(bench.run_until_ended() == "the server said goodbye: the server stops");
  CHECK(bench.messages.empty());
}

TEST_CASE("a link gets the messages that a goodbye has overtaken", "[net]") {
  LinkBench bench;
  bench.serve(false);
  bench.connect();
  bench.run_until_connected();
  constexpr std::size_t kCount = 3'000;
  const auto message = encode_message(Reject{1, RejectReason::busy, std::string(200, 'x'), 0});
  for (std::size_t i = 0; i < kCount; ++i) REQUIRE(bench.server->peer->send(message));
  bench.server->peer->close(GoodbyeReason::closing, "the server stops");
  CHECK(bench.run_until_ended() == "the server said goodbye: the server stops");
  CHECK(bench.messages.size() == kCount);
}

TEST_CASE("a link ends if nobody listens", "[net]") {
  LinkBench bench(TlsContext::client());
  {
    const tcp::acceptor gone = listen_on(bench.io);
    bench.connect(gone);
  }
  CHECK(bench.run_until_ended() == "cannot connect: Connection refused");
  CHECK_FALSE(bench.is_connected);
}

TEST_CASE("a link ends if only one side speaks TLS", "[net]") {
  const bool is_link_encrypted = GENERATE(true, false);
  LinkBench bench(link_tls(is_link_encrypted));
  bench.serve(!is_link_encrypted);
  bench.connect();
  if (!is_link_encrypted) {
    bench.run_until([&] { return bench.is_connected; });
    CHECK(bench.link->send(encode_message(hello_of_server())));
  }
  CHECK(bench.run_until_ended() ==
        (is_link_encrypted ? "TLS: the server does not speak TLS"
                           : "the server said goodbye: this server speaks TLS 1.3 only"));
  CHECK(bench.is_connected != is_link_encrypted);
}

TEST_CASE("a link ends if the server does not answer in time", "[net]") {
  LinkBench bench(TlsContext::client());
  const tcp::acceptor silent = listen_on(bench.io);
  bench.connect(silent, milliseconds(20));
  CHECK(bench.run_until_ended() == "TLS: it was closed or took too long");
  CHECK_FALSE(bench.is_connected);
}

TEST_CASE("a link that is closed while it connects ends at once", "[net]") {
  LinkBench bench(TlsContext::client());
  const tcp::acceptor silent = listen_on(bench.io);
  bench.connect(silent);
  const bool is_begun = GENERATE(true, false);
  if (is_begun) bench.run_for(milliseconds(20));
  bench.link->close("this server stops");
  CHECK(bench.run_until_ended() == "this server stops");
  CHECK_FALSE(bench.is_connected);
}

TEST_CASE("a link ends if the server sends what no server sends", "[net]") {
  LinkBench bench;
  tcp::acceptor acceptor = listen_on(bench.io);
  tcp::socket peer = bench.connect_and_accept(acceptor);
  Bytes bytes;
  FrameWriter().append(encode_message(hello_of_server()), bytes);
  asio::write(peer, asio::buffer(bytes));
  peer.shutdown(tcp::socket::shutdown_send);
  CHECK(begins_with(bench.run_until_ended(), "bad bytes from the server: "));
  CHECK(bench.messages.empty());
}

TEST_CASE("a link pauses while too many messages wait, and goes on", "[net]") {
  const bool is_encrypted = GENERATE(true, false);
  LinkBench bench(link_tls(is_encrypted));
  bench.serve(is_encrypted);
  bench.connect();
  bench.run_until_connected();
  bench.is_quick = false;
  bench.server->peer->trust();  // it may queue so many messages
  constexpr std::size_t kCount = 100'000, kMessageBytes = 64, kReadBytes = 4 * 1024;
  const auto message = encode_message(Durable{1, 7, false});
  const std::size_t counted = message.bytes->size() + kMessageBytes;
  for (std::size_t i = 0; i < kCount; ++i) REQUIRE(bench.server->peer->send(message));
  std::size_t pauses = 0;
  while (bench.messages.size() < kCount) {
    const std::size_t before = bench.messages.size();
    const auto is_full = [&] {
      return bench.messages.size() == kCount ||
             bench.waiting.size() * counted >= TrustedLimits::kUnhandledBytes;
    };
    bench.run_until(is_full);
    if (bench.messages.size() < kCount) {
      ++pauses;
      bench.run_for(milliseconds(20));
      CHECK(bench.waiting.size() * counted <
            TrustedLimits::kUnhandledBytes + counted * (kReadBytes / kFrameHeaderBytes));
    }
    REQUIRE(bench.messages.size() > before);
    bench.handle_all();
  }
  CHECK(pauses >= 2);
  CHECK(bench.ended.empty());
}

TEST_CASE("a link queues 64 MiB of edits, and ends although the server does not read", "[net]") {
  LinkBench bench;
  tcp::acceptor acceptor = listen_on(bench.io);
  const tcp::socket peer = bench.connect_and_accept(acceptor);
  const EncodedMessage edit{kKindOf<EditRequest>, std::make_shared<const Bytes>(1024 * 1024)};
  std::size_t queued = 0;
  while (queued < 1'000 && bench.link->send(edit)) ++queued;
  CHECK(queued == 64);
  bench.link->close("the owner reads too slowly");
  CHECK(bench.run_until_ended() == "the owner reads too slowly");
}
