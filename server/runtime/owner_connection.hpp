// OwnerConnection: the connection of a server that follows with the owner of its world. It makes
// one at a time, to the address that it is told, and reports what comes to WorldServer. It makes no
// further attempt by itself: whoever watches the lease knows the address of the next owner.
// Threads: connect_to() any; the others the world strand.
#pragma once
#include <asio/any_io_executor.hpp>
#include <asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "server/net/outgoing_link.hpp"
#include "server/runtime/world_strand.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

class OwnerConnection {
 public:
  /// `io`, `strand` and the threads of `decoders` must outlive the object. `is_encrypted`: the
  /// owner takes encrypted connections only.
  OwnerConnection(asio::io_context& io, WorldStrand& strand, asio::any_io_executor decoders,
                  std::uint16_t chunk_edge, bool is_encrypted);

  /// Sets what gets the messages. Call it before connect_to().
  void attach(WorldServer& world) { world_ = &world; }
  /// Connects to the owner at HOST:PORT, unless a connection there exists or is being made, this
  /// server does not follow, or end() was called. Ends a connection that leads elsewhere; a later
  /// call then connects.
  void connect_to(const std::string& address);
  /// Queues a message. Returns false if there is no room, or no connection.
  bool send(const EncodedMessage& message) { return link_ != nullptr && link_->send(message); }
  /// Returns HOST:PORT to which the connection leads, or led.
  const std::string& address() const { return address_; }
  /// Ends the connection. Its end is reported later.
  void leave(const std::string& why);
  /// Ends the connection and makes no other one.
  void end(const std::string& why);

 private:
  void connect(const std::string& address);
  /// Notes a reason why there is no connection. Returns true if it was not logged yet.
  bool is_not_logged_yet(const std::string& reason);

  asio::io_context& io_;
  WorldStrand& strand_;
  const asio::any_io_executor decoders_;
  const std::uint16_t chunk_edge_;
  const bool is_encrypted_;
  WorldServer* world_ = nullptr;
  // Used on the world strand.
  std::shared_ptr<OutgoingLink> link_;    // null: there is no connection
  std::string address_;                   // to which it leads
  std::set<std::string> logged_reasons_;  // for ends since the last connection that was live
  bool has_ended_ = false;
};

}  // namespace runstone
