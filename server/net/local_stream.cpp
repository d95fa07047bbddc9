#include <linux/sockios.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <utility>

#include "server/net/socket_stream.hpp"

namespace runstone {
namespace {

// Bytes that may wait in the kernel for the gateway. An edit cannot overtake them.
constexpr std::size_t kWaitingBytesMax = 64 * 1024;
constexpr TimeUs kGatewayAgainUs = 1'000;

class LocalStream final : public SocketStream {
 public:
  LocalStream(asio::local::stream_protocol::socket socket, const asio::ip::tcp::endpoint& client,
              AddressForm log_form)
      : SocketStream(std::move(socket)) {
    set_peer(client, log_form);
  }

  StreamRoom room() override {
    int waiting = 0;
    if (::ioctl(socket().native_handle(), SIOCOUTQ, &waiting) != 0) return {};
    const auto bytes = static_cast<std::size_t>(waiting);
    return {kWaitingBytesMax - std::min(kWaitingBytesMax, bytes), kGatewayAgainUs};
  }
};

}  // namespace

std::unique_ptr<ByteStream> make_local_stream(asio::local::stream_protocol::socket socket,
                                              const asio::ip::tcp::endpoint& client,
                                              AddressForm log_form) {
  return std::make_unique<LocalStream>(std::move(socket), client, log_form);
}

}  // namespace runstone
