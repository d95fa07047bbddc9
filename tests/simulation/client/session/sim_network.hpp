// SimNetwork: connections between a client and the server, cut by either side or by the simulation.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "protocol/codec/messages.hpp"
#include "tests/simulation/client/session/sim_pipe.hpp"
#include "tests/simulation/client/session/sim_sender.hpp"

namespace runstone::test {

/// How one end handles what it receives.
struct SimEnd {
  std::function<Result<void>(MessageKind, ByteView)> on_message;
  std::function<void(const Error&)> on_bad_stream;
  std::function<void()> on_closed;
  std::function<void()> on_drained;
};

/// A connection: two pipes, a sender and a reader at each end. Closing it from one end reaches the
/// other a moment later.
class SimConnection {
 public:
  SimConnection(VirtualTime& time, SplitMix64& rng, const LinkFaults& faults,
                std::size_t server_queue_bytes, SimEnd server, SimEnd client)
      : time_(time),
        server_(std::move(server)),
        client_(std::move(client)),
        server_reader_(Sender::client),
        client_reader_(Sender::server),
        to_server_(time, rng, faults,
                   [this](ByteView bytes) { feed(server_reader_, server_, bytes); }),
        to_client_(time, rng, faults,
                   [this](ByteView bytes) { feed(client_reader_, client_, bytes); }),
        server_sender_(time, rng, to_client_, server_queue_bytes, [this] { server_.on_drained(); }),
        client_sender_(time, rng, to_server_, SIZE_MAX / 2, [this] { client_.on_drained(); }) {}

  bool send_from_server(const EncodedMessage& message) {
    return open_ && server_sender_.send(message);
  }
  bool send_from_client(const EncodedMessage& message) {
    return open_ && client_sender_.send(message);
  }
  bool open() const { return open_; }
  bool server_idle() const { return server_sender_.idle(); }

  /// Cuts the connection: nothing more arrives, and both ends are notified.
  void cut() {
    if (!open_) return;
    open_ = false;
    to_server_.cut();
    to_client_.cut();
    time_.after(1000, [end = client_.on_closed] { end(); });
    time_.after(1500, [end = server_.on_closed] { end(); });
  }
  /// The server is gone: only the client is notified.
  void server_died() {
    if (!open_) return;
    open_ = false;
    to_server_.cut();
    to_client_.cut();
    time_.after(1000, [end = client_.on_closed] { end(); });
  }

 private:
  void feed(FrameReader& reader, SimEnd& end, ByteView bytes) {
    const auto result = reader.feed(bytes, end.on_message);
    if (!result) end.on_bad_stream(result.error());
  }

  VirtualTime& time_;
  SimEnd server_, client_;
  FrameReader server_reader_, client_reader_;
  SimPipe to_server_, to_client_;
  SimSender server_sender_, client_sender_;
  bool open_ = true;
};

}  // namespace runstone::test
