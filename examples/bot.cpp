// A bot: joins a server, places one voxel of stone above the spawn point and leaves.
//   example-bot HOST PORT
// Exit codes: 0 if the server ordered the edit, 1 if it did not within ten seconds, 2 on a bad
// command line.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <variant>

#include "client/net/key_file.hpp"
#include "client/net/net_client.hpp"
#include "client/net/wake_up.hpp"
#include "client/session/client_session.hpp"
#include "common/os/steady_clock.hpp"

using namespace runstone;

namespace {

class ExampleBot {
 public:
  explicit ExampleBot(LinkConfig server)
      : session_(config()), net_(std::move(server), [this] { wake_up_.notify(); }) {}

  /// Runs until the server ordered the edit or the time is over. Returns true if it was ordered.
  bool run(TimeUs end_us) {
    while (!is_ordered() && steady_now_us() < end_us) {
      wake_up_.wait(std::chrono::milliseconds(10));
      for (LinkEvent& event : net_.take_events()) handle(event);
      session_.tick(steady_now_us());
      if (session_.loaded() && !placed_) place();
      flush();
    }
    session_.close(GoodbyeReason::closing, "");
    flush();
    net_.stop(1000);
    return is_ordered();
  }

 private:
  static SessionConfig config() {
    SessionConfig out;
    out.keys = random_key();  // a new player; load_or_create_key() keeps one
    out.name = "example";
    out.instance = random_instance();
    out.view.radius_h = out.view.radius_v = 1;
    return out;
  }

  void handle(LinkEvent& event) {
    const TimeUs now_us = steady_now_us();
    if (const auto* connected = std::get_if<LinkConnected>(&event)) {
      connection_ = connected->connection;
      session_.connected(random_nonce(), connected->binding, now_us);
    } else if (auto* received = std::get_if<LinkReceived>(&event)) {
      session_.receive(std::move(received->message),
                       {received->received_us, received->unpacked_us, now_us});
    } else {
      session_.disconnected();  // the link connects again by itself
    }
  }

  void place() {
    const auto stone = session_.welcome()->materials.find("stone");
    const auto seq = session_.offer({SetVoxel{target_}, {}, stone.value_or(1)}, steady_now_us(),
                                    steady_now_us());
    placed_ = seq.has_value();
  }

  /// Returns true if the server's version of the chunk has the voxel.
  bool is_ordered() const {
    if (!placed_) return false;
    const std::int32_t edge = session_.replica().chunk_edge();
    const ChunkPtr chunk = session_.replica().confirmed({0, chunk_of(target_, edge)});
    return chunk && material_at(chunk->voxels, local_of(target_, edge)) != kEmpty;
  }

  void flush() {
    for (const Message& message : session_.take_outgoing())
      net_.send(connection_, encode_message(message));
    if (session_.wants_close()) net_.close(connection_);
  }

  const VoxelPos target_{0, 20, 0};
  WakeUp wake_up_;
  ClientSession session_;
  ConnectionNumber connection_ = 0;
  bool placed_ = false;
  NetClient net_;  // the last member: its thread stops before the others are destroyed
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: example-bot HOST PORT\n");
    return 2;
  }
  LinkConfig server;
  server.host = argv[1];
  server.port = static_cast<std::uint16_t>(std::atoi(argv[2]));
  ExampleBot bot(std::move(server));
  const bool is_ordered = bot.run(steady_now_us() + 10'000'000);
  std::printf("%s\n", is_ordered ? "the edit was ordered" : "the edit was not ordered");
  return is_ordered ? 0 : 1;
}
