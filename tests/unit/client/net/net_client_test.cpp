#include "client/net/net_client.hpp"

#include <algorithm>
#include <asio.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <optional>
#include <thread>

#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/runs/worst_chunk.hpp"
#include "tests/unit/client/net/next_event.hpp"

using namespace runstone;
using asio::ip::tcp;

namespace {

/// A server that each test controls by hand. Its sockets block, so that the order of events is
/// certain.
struct Peer {
  Peer() : acceptor(io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)), socket(io) {}
  std::uint16_t port() const { return acceptor.local_endpoint().port(); }
  void accept() {
    socket = acceptor.accept();
    writer = FrameWriter();
    reader.emplace(Sender::client);
  }
  void send(const Message& message) {
    Bytes out;
    writer.append(encode_message(message), out);
    asio::write(socket, asio::buffer(out));
  }
  /// Returns the next message, or nullopt if the client has closed the connection.
  std::optional<Message> receive() {
    std::optional<Message> got;
    while (!got) {
      std::uint8_t byte = 0;  // byte by byte, so that no byte of the next message is read
      std::error_code error;
      if (socket.read_some(asio::buffer(&byte, 1), error) == 0) return std::nullopt;
      const auto fed =
          reader->feed({&byte, 1}, [&](MessageKind kind, ByteView body) -> Result<void> {
            auto message = decode_message(Sender::client, kind, body, 0);
            REQUIRE(message.has_value());
            got = std::move(*message);
            return {};
          });
      REQUIRE(fed.has_value());
    }
    return got;
  }
  asio::io_context io;
  tcp::acceptor acceptor;
  tcp::socket socket;
  FrameWriter writer;
  std::optional<FrameReader> reader;
};

struct Fixture {
  LinkConfig config() const {
    LinkConfig out;
    out.tls.reset();  // the server of these tests has no TLS
    out.host = "127.0.0.1";
    out.port = peer.port();
    out.pause_ms_first = 1;
    out.pause_ms_max = 10;
    return out;
  }
  void start(LinkConfig net) {
    client = std::make_unique<NetClient>(std::move(net), [this] { wake.notify(); });
  }
  /// Returns the next event. Fails the test if none comes.
  LinkEvent next() { return test::next_event(*client, wake, events); }
  template <class T>
  T next_as() {
    LinkEvent event = next();
    REQUIRE(std::holds_alternative<T>(event));
    return std::get<T>(std::move(event));
  }
  Welcome welcome() const {
    Welcome out;
    out.epoch = 1;
    out.chunk_edge = 16;
    out.materials = default_material_table();
    return out;
  }
  Peer peer;
  WakeUp wake;
  std::vector<LinkEvent> events;
  std::unique_ptr<NetClient> client;
};

}  // namespace

TEST_CASE_METHOD(Fixture, "messages go both ways, whole and in order", "[client_net]") {
  start(config());
  peer.accept();
  const auto up = next_as<LinkConnected>();
  CHECK(up.connection == 1);
  Hello hello;
  hello.name = "ada";
  client->send(up.connection, encode_message(hello));
  client->send(up.connection, encode_message(Ping{123}));
  auto got = peer.receive();
  REQUIRE(got);
  CHECK(std::get<Hello>(*got).name == "ada");
  got = peer.receive();
  REQUIRE(got);
  CHECK(std::get<Ping>(*got).sent_us == 123);

  peer.send(welcome());
  const auto first = next_as<LinkReceived>();
  CHECK(std::get<Welcome>(first.message).chunk_edge == 16);
  CHECK(first.connection == 1);
  CHECK(first.received_us <= first.unpacked_us);
  CHECK(first.bytes > 0);

  // Snapshots are accepted only if they have the chunk edge of Welcome.
  Bytes out;
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(16), 3);
  chunk.digest = digest_of(chunk.voxels);
  const ChunkEntry entry = encode_snapshot({0, {1, 2, 3}}, chunk, ChunkEncoding::packed);
  peer.writer.append(join_entries(1, {&entry, 1}), out);
  asio::write(peer.socket, asio::buffer(out.data(), 5));
  asio::write(peer.socket, asio::buffer(out.data() + 5, out.size() - 5));
  const auto second = next_as<LinkReceived>();
  const auto& chunks = std::get<Chunks>(second.message).chunks;
  REQUIRE(chunks.size() == 1);
  CHECK(key_of(chunks[0]) == ChunkKey{0, {1, 2, 3}});
  const Traffic received = client->stats().received.read();
  CHECK(received[first.message.index()] == KindTraffic{1, first.bytes, 1});
  CHECK(received[second.message.index()] == KindTraffic{1, second.bytes, 1});
  CHECK(of_class(received, FrameClass::chunks) == KindTraffic{1, second.bytes, 1});
}

TEST_CASE_METHOD(Fixture,
                 "a lost connection is made again, and messages for the old one are dropped",
                 "[client_net]") {
  start(config());
  peer.accept();
  CHECK(next_as<LinkConnected>().connection == 1);
  peer.socket.close();
  CHECK(next_as<LinkDisconnected>().connection == 1);
  peer.accept();
  CHECK(next_as<LinkConnected>().connection == 2);
  client->send(1, encode_message(Ping{1}));
  client->send(2, encode_message(Ping{2}));
  const auto got = peer.receive();
  REQUIRE(got);
  CHECK(std::get<Ping>(*got).sent_us == 2);
}

TEST_CASE_METHOD(Fixture, "a lost connection is made again at another server of the list",
                 "[client_net]") {
  Peer other;
  const std::uint16_t other_port = other.port();
  const auto address_of = [](const Peer& server) {
    return "127.0.0.1:" + std::to_string(server.port());
  };
  Servers list{{{address_of(peer)}, {address_of(other)}}, 0};
  std::ranges::sort(list.servers, {}, &ServerEntry::address);
  start(config());
  peer.accept();
  CHECK_FALSE(next_as<LinkConnected>().is_listed);
  client->set_servers(seen_from(list, address_of(peer)));
  SECTION("because the connection breaks") { peer.socket.close(); }
  SECTION("because the server says goodbye") {
    peer.send(Goodbye{GoodbyeReason::closing, "the server stops"});
    next_as<LinkReceived>();
    client->close(1);
  }
  const auto lost = next_as<LinkDisconnected>();
  CHECK(lost.connection == 1);
  CHECK(lost.server == HostPort{"127.0.0.1", peer.port()});
  other.accept();
  const auto up = next_as<LinkConnected>();
  CHECK(up.connection == 2);
  CHECK(up.is_listed);

  // From there, the first server is the other one.
  client->set_servers(seen_from(list, address_of(other)));
  other.acceptor.close();
  other.socket.close();
  CHECK(next_as<LinkDisconnected>().server == HostPort{"127.0.0.1", other_port});
  peer.accept();
  CHECK_FALSE(next_as<LinkConnected>().is_listed);
}

TEST_CASE_METHOD(Fixture, "every given address is tried", "[client_net]") {
  Peer other;
  LinkConfig net = config();
  net.more = {{"127.0.0.1", other.port()}};
  peer.acceptor.close();
  start(net);
  other.accept();
  while (std::holds_alternative<LinkDisconnected>(next())) {
  }
  client->send(1, encode_message(Ping{1}));
  CHECK(other.receive().has_value());
}

TEST_CASE_METHOD(Fixture, "bytes that are no frames end the connection with a reason",
                 "[client_net]") {
  start(config());
  peer.accept();
  next_as<LinkConnected>();
  const std::string nonsense(64, 'x');
  asio::write(peer.socket, asio::buffer(nonsense));
  CHECK_THAT(next_as<LinkDisconnected>().why, Catch::Contains("bad bytes"));
}

TEST_CASE_METHOD(Fixture, "a snapshot of the wrong size ends the connection", "[client_net]") {
  start(config());
  peer.accept();
  next_as<LinkConnected>();
  peer.send(welcome());
  next_as<LinkReceived>();
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(32), 3);
  Bytes out;
  const ChunkEntry entry = encode_snapshot({0, {}}, chunk, ChunkEncoding::raw);
  peer.writer.append(join_entries(1, {&entry, 1}), out);
  asio::write(peer.socket, asio::buffer(out));
  CHECK_THAT(next_as<LinkDisconnected>().why, Catch::Contains("bad bytes"));
}

TEST_CASE_METHOD(Fixture, "each failed attempt is an event, and attempts go on", "[client_net]") {
  LinkConfig net = config();
  peer.acceptor.close();
  start(net);
  for (int i = 0; i < 3; ++i) CHECK(next_as<LinkDisconnected>().connection == 0);
  net.host = "name.invalid";
  start(net);
  events.clear();
  CHECK_THAT(next_as<LinkDisconnected>().why, Catch::Contains("cannot resolve"));
}

TEST_CASE_METHOD(Fixture, "closing sends what is queued first", "[client_net]") {
  start(config());
  peer.accept();
  const auto up = next_as<LinkConnected>();
  client->send(up.connection, encode_message(Goodbye{GoodbyeReason::closing, "bye"}));
  client->close(up.connection);
  const auto got = peer.receive();
  REQUIRE(got);
  CHECK(std::get<Goodbye>(*got).text == "bye");
  CHECK_FALSE(peer.receive());
  CHECK(next_as<LinkDisconnected>().connection == 1);
}

TEST_CASE_METHOD(Fixture, "stopping sends what is queued and does not connect again",
                 "[client_net]") {
  start(config());
  peer.accept();
  const auto up = next_as<LinkConnected>();
  client->send(up.connection, encode_message(Ping{9}));
  client->stop(5'000);
  const auto got = peer.receive();
  REQUIRE(got);
  CHECK(std::get<Ping>(*got).sent_us == 9);
  CHECK_FALSE(peer.receive());
  CHECK(client->stats().connections == 1);
}

TEST_CASE_METHOD(Fixture, "reading stops while events are not taken, and no message is lost",
                 "[client_net]") {
  LinkConfig net = config();
  net.events_max = 16;
  start(net);
  peer.accept();
  next_as<LinkConnected>();
  constexpr TimeUs kMessages = 40'000;
  std::thread sender([&] {
    for (TimeUs i = 0; i < kMessages; ++i) peer.send(Pong{i, i});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (LinkEvent& event : client->take_events()) events.push_back(std::move(event));
  // One decoded piece of a read may exceed the bound.
  CHECK(events.size() < 64);
  bool in_order = true;
  for (TimeUs i = 0; i < kMessages; ++i) {
    const LinkEvent event = next();
    const auto* received = std::get_if<LinkReceived>(&event);
    in_order = in_order && received != nullptr && std::get<Pong>(received->message).sent_us == i;
  }
  sender.join();
  CHECK(in_order);
}

TEST_CASE_METHOD(Fixture, "few bytes that decode to much memory stop the reading", "[client_net]") {
  LinkConfig net = config();
  net.event_bytes_max = 64 << 10;
  start(net);
  peer.accept();
  next_as<LinkConnected>();
  peer.send(welcome());
  next_as<LinkReceived>();
  // Some 15 KiB of runs, in a few dozen bytes on the wire.
  const ChunkEntry entry =
      encode_snapshot({0, {0, 0, 0}}, test::worst_chunk(16), ChunkEncoding::packed);
  constexpr std::size_t kSent = 200;
  Bytes out;
  for (std::size_t i = 0; i < kSent; ++i) peer.writer.append(join_entries(1, {&entry, 1}), out);
  CHECK(out.size() < kSent * 256);
  asio::write(peer.socket, asio::buffer(out));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (LinkEvent& event : client->take_events()) events.push_back(std::move(event));
  CHECK(events.size() >= 4);
  CHECK(events.size() < 12);  // about five chunks are 64 KiB; 256 bytes more hold a few
  for (std::size_t i = 0; i < kSent; ++i) next_as<LinkReceived>();
}
