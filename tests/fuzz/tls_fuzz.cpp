// The target gives any bytes to one end of a TLS connection: to a server or a client that waits for
// the first bytes, or to a server behind a good handshake, as a part of the stream whose other bytes
// are genuine. The end fails or waits; it never answers with more than a peer can make it send, and
// returns no text that the other end did not write.
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/tls/tls_channel.hpp"

namespace runstone {
namespace {

// The flight of a server with certificate, or a hello of a client, with room.
constexpr std::size_t kAnswerBytesMax = 8 * 1024;
constexpr int kStepsMax = 64;

struct FuzzWire final : TlsSource {
  Bytes bytes;
  std::size_t receive(std::span<std::uint8_t> into) override {
    const std::size_t count = std::min(into.size(), bytes.size());
    std::copy_n(bytes.begin(), count, into.begin());
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
};

const TlsContext& server_context() {
  constexpr std::array<std::uint8_t, 32> kSeed{1, 2, 3};
  static const TlsContext context = TlsContext::self_signed_server(kSeed);
  return context;
}
const TlsContext& client_context() {
  static const TlsContext context = TlsContext::client();
  return context;
}

void check_first_bytes(bool is_server, ByteView bytes) {
  FuzzWire wire;
  TlsChannel channel = is_server ? TlsChannel::accept(server_context(), wire)
                                 : TlsChannel::connect(client_context(), wire, "localhost");
  if (!is_server) (void)channel.handshake();  // writes its hello
  channel.output().clear();
  wire.bytes.assign(bytes.begin(), bytes.end());
  for (int step = 0; step < kStepsMax; ++step) {
    const auto status = channel.handshake();
    RUNSTONE_ASSERT(status != TlsChannel::Status::done);  // nobody guesses a handshake
    if (status != TlsChannel::Status::wants_input || wire.bytes.empty()) break;
  }
  RUNSTONE_ASSERT(channel.output().size() <= kAnswerBytesMax);
}

/// A pair of ends whose handshake is done.
struct OpenPair {
  OpenPair()
      : server(TlsChannel::accept(server_context(), to_server)),
        client(TlsChannel::connect(client_context(), to_client, "localhost")) {
    for (int round = 0; round < 3; ++round) {
      (void)client.handshake();
      move(client, to_server);
      (void)server.handshake();
      move(server, to_client);
    }
  }
  static void move(TlsChannel& from, FuzzWire& to) {
    to.bytes.insert(to.bytes.end(), from.output().begin(), from.output().end());
    from.output().clear();
  }

  FuzzWire to_server, to_client;
  TlsChannel server, client;
};

void check_stream(ByteView bytes) {
  constexpr std::array<std::uint8_t, 40> kText{'t', 'e', 'x', 't'};
  OpenPair pair;
  RUNSTONE_ASSERT(pair.client.write(kText));
  OpenPair::move(pair.client, pair.to_server);
  // The first byte says where the others are put: in front of the record, inside it, or behind it.
  Bytes& stream = pair.to_server.bytes;
  const std::size_t at = bytes.empty() ? 0 : bytes[0] % (stream.size() + 1);
  if (!bytes.empty())
    stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + 1, bytes.end());
  Bytes text, buffer(64);
  for (int step = 0; step < kStepsMax; ++step) {
    std::size_t count = 0;
    if (pair.server.read(buffer, count) != TlsChannel::Status::done) break;
    text.insert(text.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(count));
  }
  RUNSTONE_ASSERT(text.empty() || std::equal(text.begin(), text.end(), kText.begin(), kText.end()));
  RUNSTONE_ASSERT(pair.server.output().size() <= kAnswerBytesMax);
}

}  // namespace
}  // namespace runstone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  if (size == 0 || size > 20'000) return 0;
  const ByteView bytes(data + 1, size - 1);
  if (data[0] % 8 == 0) {
    check_stream(bytes);
  } else {
    check_first_bytes(data[0] % 8 != 1, bytes);
  }
  return 0;
}
