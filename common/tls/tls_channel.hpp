// TlsChannel: one end of a TLS connection without a socket. It takes the bytes that arrived from a
// TlsSource and appends those to be sent to a buffer. So the server, the client and tests use the
// same code with their own sockets, or with none.
// The channel keeps no buffer while it is idle: OpenSSL reads a record from the source as it
// arrives, and the caller takes the output at once.
// Threads: one at a time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/channel_binding.hpp"
#include "common/tls/tls_context.hpp"

namespace runstone {

/// The greatest size of the text in a TLS record. A receiver sees nothing of a record before it has
/// all of it.
inline constexpr std::size_t kTlsRecordBytesMax = 16 * 1024;
/// What a TLS 1.3 record has besides its text: header, content type and tag of AES-GCM.
inline constexpr std::size_t kTlsRecordExtraBytes = 5 + 1 + 16;

/// The bytes that arrived.
class TlsSource {
 public:
  virtual ~TlsSource() = default;
  /// Copies up to `into.size()` bytes that have arrived and returns their number. Returns 0 if none
  /// have. At the end of the stream and after an error it returns 0, too; the source knows.
  virtual std::size_t receive(std::span<std::uint8_t> into) = 0;
};

class TlsChannel {
 public:
  /// Makes the server's end.
  static TlsChannel accept(const TlsContext& context, TlsSource& source);
  /// Makes the client's end. `host` is the name or the address of the server, not empty: it is sent
  /// to the server if it is a name, and compared with the certificate if the context has
  /// authorities.
  static TlsChannel connect(const TlsContext& context, TlsSource& source, const std::string& host);
  ~TlsChannel();
  TlsChannel(TlsChannel&&) noexcept;
  TlsChannel& operator=(TlsChannel&&) noexcept;

  enum class Status {
    done,
    wants_input,  // call again when the source has more
    ended,        // the peer has ended its direction in the way of TLS
    failed,       // see error(); what output() holds tells the peer
  };
  /// Continues the handshake. Cost, once for each connection: about 0.3 ms.
  Status handshake();
  /// Reads up to `into.size()` bytes; `bytes` is their number if the status is done. Fails if the
  /// peer changes its keys more than 32 times.
  Status read(std::span<std::uint8_t> into, std::size_t& bytes);
  /// Encrypts the text as records of at most kTlsRecordBytesMax bytes of it. Requires the end of
  /// the handshake. Returns false after a failure.
  bool write(ByteView text);
  /// Tells the peer that nothing more will be written.
  void end();

  /// The bytes to be sent to the peer. The caller removes what it has sent.
  Bytes& output();
  /// Returns why the channel failed, such as "wrong version number".
  const std::string& error() const;
  /// Returns "tls-exporter" of RFC 9266. Requires the end of the handshake.
  ChannelBinding binding() const;

 private:
  struct State;
  explicit TlsChannel(std::unique_ptr<State> state);
  static TlsChannel open(const TlsContext& context, TlsSource& source);
  Status status_of(int result);
  std::unique_ptr<State> state_;
};

}  // namespace runstone
