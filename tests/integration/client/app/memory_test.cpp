// The memory of the real client program, against a server that sends chunks which are small on the
// wire and take as much memory as chunks can.
#include <sys/resource.h>

#include <algorithm>
#include <asio.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/integration/client/window/child_process.hpp"
#include "tests/support/codec/test_keys.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/runs/worst_chunk.hpp"

namespace runstone::test {
namespace {

using asio::ip::tcp;

constexpr std::uint16_t kHostileEdge = 64;
constexpr std::size_t kMiB = std::size_t{1} << 20;

/// A server of one client. It sends a chunk of the worst case for each chunk of each view, and ends
/// the session when the client has requested no other view for a while.
class HostileServer {
 public:
  HostileServer() : acceptor_(io_, tcp::endpoint(asio::ip::address_v4::loopback(), 0)) {}
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  std::size_t views() const { return views_; }

  void serve() {
    tcp::socket socket = acceptor_.accept();
    FrameReader reader(Sender::client);
    std::vector<std::uint8_t> buffer(64 * 1024);
    const auto quiet = std::chrono::seconds(4);
    auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < until) {
      if (socket.available() == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        continue;
      }
      const std::size_t count = socket.read_some(asio::buffer(buffer));
      const std::size_t views_before = views_;
      const auto fed =
          reader.feed(ByteView(buffer.data(), count), [&](MessageKind kind, ByteView body) {
            auto message = decode_message(Sender::client, kind, body, kHostileEdge);
            if (!message) return Result<void>(failure(message.error()));
            answer(*message, socket);
            return Result<void>{};
          });
      REQUIRE(fed.has_value());
      if (views_ != views_before) until = std::chrono::steady_clock::now() + quiet;
    }
    send(Goodbye{GoodbyeReason::closing, "enough"}, socket);
  }

 private:
  void answer(const Message& message, tcp::socket& socket) {
    if (const auto* hello = std::get_if<Hello>(&message)) {
      Welcome welcome;
      welcome.epoch = 1;
      welcome.chunk_edge = kHostileEdge;
      welcome.materials = default_material_table();
      welcome.server_key = keys(9).public_key;
      welcome.encoding = ChunkEncoding::packed;
      welcome.view_radius_max = 16;
      welcome.edit_volume_max = 1000;
      welcome.signature = sign(keys(9), server_transcript(*hello, welcome, std::nullopt));
      send(welcome, socket);
    } else if (std::holds_alternative<ClientAuth>(message)) {
      send(SessionAccepted{1, 0}, socket);
    } else if (const auto* ping = std::get_if<Ping>(&message)) {
      send(Pong{ping->sent_us, ping->sent_us}, socket);
    } else if (const auto* view = std::get_if<View>(&message)) {
      send_chunks(*view, socket);
    }
  }
  void send_chunks(const View& view, tcp::socket& socket) {
    ++views_;
    std::erase_if(sent_, [&](ChunkCoord at) { return !view.contains(at); });
    const std::int32_t h = view.radius_h, v = view.radius_v;
    for (std::int32_t x = -h; x <= h; ++x) {
      for (std::int32_t y = -v; y <= v; ++y) {
        for (std::int32_t z = -h; z <= h; ++z) {
          const ChunkCoord at{view.centre.x + x, view.centre.y + y, view.centre.z + z};
          if (!view.contains(at) || !sent_.insert(at).second) continue;
          const ChunkEntry entry = encode_snapshot({0, at}, worst_, ChunkEncoding::packed);
          CHECK(entry.bytes->size() < 8'000);
          send(join_entries(view.number, {&entry, 1}), socket);
        }
      }
    }
  }
  void send(const Message& message, tcp::socket& socket) { send(encode_message(message), socket); }
  void send(const EncodedMessage& message, tcp::socket& socket) {
    Bytes out;
    writer_.append(message, out);
    asio::write(socket, asio::buffer(out));
  }

  asio::io_context io_;
  tcp::acceptor acceptor_;
  FrameWriter writer_;
  const Chunk worst_ = worst_chunk(kHostileEdge);
  std::set<ChunkCoord> sent_;
  std::size_t views_ = 0;
};

}  // namespace

TEST_CASE("a server that sends chunks of the worst case cannot make the client exceed its memory",
          "[integration][memory]") {
  const TempFolder folder;
  HostileServer server;
  // Of 203 chunks in view, each takes 1 MiB of runs and 6 MiB of quads.
  ChildProcess client({RUNSTONE_CLIENT_PROGRAM, "--insecure", "--connect",
                       "127.0.0.1:" + std::to_string(server.port()), "--no-render", "--view", "3",
                       "--view-vertical", "3", "--memory-mib", "128", "--workers", "1", "--report",
                       folder / "report.json", "--exit-on-goodbye"},
                      folder / "output");
  server.serve();
  REQUIRE(client.wait(std::chrono::seconds(60)) == 0);
  CHECK(server.views() > 1);
  std::ifstream file(folder / "report.json");
  const auto report = nlohmann::json::parse(file);
  const auto& memory = report["memory"];
  INFO(memory.dump());
  CHECK(memory["bytes"] <= 128 * kMiB);
  CHECK(memory["peak_bytes"] <= 160 * kMiB);  // what arrived between two turns of the main loop
  CHECK(memory["view_shrinks"] >= 1);
  CHECK(report["replica"]["confirmed_chunks"] >= 1);
  CHECK(report["mesh"]["kept_bytes"] > 0);
#ifndef RUNSTONE_SANITIZED
  rusage usage{};
  REQUIRE(::getrusage(RUSAGE_CHILDREN, &usage) == 0);
  CHECK(static_cast<std::size_t>(usage.ru_maxrss) * 1024 < 384 * kMiB);  // 1.6 GiB without a bound
#endif
}

}  // namespace runstone::test
