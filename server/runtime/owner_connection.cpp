#include "server/runtime/owner_connection.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/default_port.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"

namespace runstone {
namespace {

constexpr std::chrono::milliseconds kConnectTimeout{2'000};
constexpr std::size_t kLoggedReasonsMax = 16;

}  // namespace

OwnerConnection::OwnerConnection(asio::io_context& io, WorldStrand& strand,
                                 asio::any_io_executor decoders, std::uint16_t chunk_edge,
                                 bool is_encrypted)
    : io_(io),
      strand_(strand),
      decoders_(std::move(decoders)),
      chunk_edge_(chunk_edge),
      is_encrypted_(is_encrypted) {}

void OwnerConnection::connect_to(const std::string& address) {
  strand_.post([this, address] {
    if (has_ended_ || !world_->order().ownership().is(OwnershipState::following)) return;
    if (link_ == nullptr) return connect(address);
    if (address == address_) return;
    // The server there may stand still, and would later speak as if it were the owner.
    leave("another server owns the world");
    world_->cluster().owner_disconnected();
  });
}

void OwnerConnection::connect(const std::string& address) {
  const auto end = parse_host_port(address, kDefaultPort);
  if (!end) {
    if (is_not_logged_yet(address))
      logger("world").error("the owner's address \"{}\" is none: {}", address, end.error());
    return;
  }
  OutgoingLink::Events events;
  events.on_connected = [this, address](const std::optional<ChannelBinding>& binding) {
    logger("world").info("connected with the owner at {}", address);
    strand_.post([this, binding] { world_->cluster().owner_connected(binding, read_clocks()); });
  };
  events.on_message = [this](Message&& message, std::size_t bytes) {
    strand_.post([this, link = link_, message = std::move(message), bytes]() mutable {
      world_->cluster().owner_received(std::move(message), read_clocks());
      if (world_->cluster().is_live()) logged_reasons_.clear();
      if (link != nullptr) link->handled(bytes);
    });
  };
  events.on_ended = [this, address](const std::string& why) {
    strand_.post([this, address, why] {
      link_.reset();
      world_->cluster().owner_disconnected();
      const OwnershipState part = world_->order().ownership().state();
      const bool is_meant =
          has_ended_ || part == OwnershipState::taking_over || part == OwnershipState::owning;
      const std::string line = address + ": " + why;
      if (!is_meant && is_not_logged_yet(line)) logger("world").warn("OWNER LOST: {}", line);
    });
  };
  std::optional<TlsContext> tls;
  if (is_encrypted_) tls = TlsContext::client();
  link_ = std::make_shared<OutgoingLink>(io_, decoders_, chunk_edge_, std::move(tls),
                                         std::move(events));
  address_ = address;
  link_->connect(*end, kConnectTimeout);
}

bool OwnerConnection::is_not_logged_yet(const std::string& reason) {
  if (logged_reasons_.size() >= kLoggedReasonsMax) logged_reasons_.clear();
  return logged_reasons_.insert(reason).second;
}

void OwnerConnection::leave(const std::string& why) {
  if (link_ != nullptr) link_->close(why);
}

void OwnerConnection::end(const std::string& why) {
  has_ended_ = true;
  leave(why);
}

}  // namespace runstone
