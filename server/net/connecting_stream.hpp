// ConnectingStream: the byte stream of an outgoing connection. open() resolves the name of the
// server, connects to the first of its addresses that answers, and performs the TLS handshake.
// After it, the stream is one over TCP or TLS.
// Bounds: close() ends open() at once, so the session's handshake time bounds it. An address that
// does not answer uses only its share of that time.
// Threads: the session's strand, as in ByteStream.
#pragma once
#include <asio/any_io_executor.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/os/host_port.hpp"
#include "server/net/byte_stream.hpp"

namespace runstone {

class ConnectingStream final : public ByteStream {
 public:
  /// `tls`: nullopt for a connection that is not encrypted. `handshakes`: as in make_tls_stream().
  /// `time`: the handshake time of the session.
  ConnectingStream(HostPort server, std::optional<TlsContext> tls, std::size_t notsent_bytes,
                   asio::any_io_executor handshakes, std::chrono::milliseconds time);
  ~ConnectingStream() override;

  asio::awaitable<StreamStart> open() override;
  std::string failure() const override { return failure_; }
  std::optional<ChannelBinding> binding() const override { return stream_->binding(); }
  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override {
    return stream_->read_some(into);
  }
  IoResult write_now(std::span<const asio::const_buffer> buffers,
                     std::size_t terrain_bytes) override {
    return stream_->write_now(buffers, terrain_bytes);
  }
  asio::awaitable<IoResult> write_rest() override { return stream_->write_rest(); }
  StreamRoom room() override { return stream_->room(); }
  void shutdown_send() override { stream_->shutdown_send(); }
  void close() override;
  /// Returns the server as it was given, not the address that answered.
  std::string peer() const override { return to_string(server_); }

 private:
  using Socket = asio::ip::tcp::socket;
  struct Lookup;
  /// Resolves the name. Returns false after a failure.
  asio::awaitable<bool> resolve();
  /// Connects attempt_ to one of the addresses found. Returns false after a failure.
  asio::awaitable<bool> connect();
  StreamStart fail_open(std::string why);

  const HostPort server_;
  const std::optional<TlsContext> tls_;
  const std::size_t notsent_bytes_;
  const asio::any_io_executor handshakes_;
  const std::chrono::milliseconds time_;
  bool is_closed_ = false;
  std::string failure_;
  // While open() runs. Handlers that outlive the stream share them.
  std::shared_ptr<Lookup> lookup_;
  std::shared_ptr<Socket> attempt_;
  std::unique_ptr<ByteStream> stream_;  // null until the socket is connected
};

}  // namespace runstone
