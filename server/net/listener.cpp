#include "server/net/listener.hpp"

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/post.hpp>
#include <chrono>
#include <utility>
#include <vector>

#include "common/os/host_port.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/default_port.hpp"
#include "server/net/address_block_of.hpp"
#include "server/net/await_tuple.hpp"

namespace runstone {
namespace {

/// Returns the budget of an address that may connect so often; 0: no limit.
Budget connection_budget(std::uint64_t per_second) {
  constexpr std::uint64_t kSecondsAtOnce = 10;
  return {per_second, per_second * kSecondsAtOnce};
}

Result<void, std::string> bind_to(asio::ip::tcp::acceptor& acceptor, const std::string& address) {
  const auto cannot_listen = [&](const std::string& why) {
    return failure("cannot listen on \"" + address + "\": " + why);
  };
  const auto parsed = parse_listen_address(address, kDefaultPort);
  if (!parsed) return cannot_listen(parsed.error());
  const auto cannot = [&](const asio::error_code& error) { return cannot_listen(error.message()); };
  asio::error_code error;
  asio::ip::tcp::resolver resolver(acceptor.get_executor());
  const auto ends = resolver.resolve(
      parsed->host, std::to_string(parsed->port),
      asio::ip::resolver_base::passive | asio::ip::resolver_base::numeric_service, error);
  if (error) return cannot(error);
  const asio::ip::tcp::endpoint end = ends.begin()->endpoint();
  acceptor.open(end.protocol(), error);
  if (error) return cannot(error);
  acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (error) return cannot(error);
  acceptor.bind(end, error);
  if (error) return cannot(error);
  acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return cannot(error);
  return {};
}

/// Returns the frame that a client gets that does not speak TLS.
Bytes goodbye_to_plain_client() {
  Bytes frame;
  FrameWriter().append(
      encode_message(Goodbye{GoodbyeReason::wrong_protocol, "this server speaks TLS 1.3 only"}),
      frame);
  return frame;
}

}  // namespace

Listener::Listener(asio::io_context& io, asio::any_io_executor decoders, const NetLimits& limits,
                   std::uint16_t chunk_edge, NetEvents& events)
    : io_(io),
      decoders_(std::move(decoders)),
      limits_(limits),
      budget_(limits.server_bytes_per_second),
      chunk_edge_(chunk_edge),
      events_(events),
      strand_(asio::make_strand(asio::any_io_executor(io.get_executor()))),
      acceptor_(strand_),
      pause_(strand_),
      connections_(connection_budget(limits.connections_per_second)) {}

Result<asio::ip::address, std::string> can_listen(const std::string& address) {
  asio::io_context io;
  asio::ip::tcp::acceptor acceptor(io);
  if (const auto bound = bind_to(acceptor, address); !bound) return failure(bound.error());
  asio::error_code error;
  const auto end = acceptor.local_endpoint(error);
  if (error) return failure("cannot listen on \"" + address + "\": " + error.message());
  return end.address();
}

Result<void, std::string> Listener::listen(const std::string& address) {
  if (const auto bound = bind_to(acceptor_, address); !bound) return bound;
  asio::error_code error;
  port_ = acceptor_.local_endpoint(error).port();
  if (error) return failure("cannot listen on " + address + ": " + error.message());
  return {};
}

void Listener::set_tls(const TlsContext& tls) {
  const std::lock_guard lock(mutex_);
  tls_ = tls;
}

void Listener::start() { asio::co_spawn(strand_, accept_loop(shared_from_this()), asio::detached); }

void Listener::stop() {
  const auto end = [self = shared_from_this()] {
    asio::error_code ignored;
    self->acceptor_.close(ignored);
    self->pause_.cancel();
  };
  asio::post(strand_, end);
}

asio::awaitable<void> Listener::accept_loop(std::shared_ptr<Listener> self) {
  while (self->acceptor_.is_open()) {
    asio::ip::tcp::socket socket(self->io_);
    const auto [error] = co_await self->acceptor_.async_accept(socket, kTuple);
    if (!error) {
      self->admit_socket(std::move(socket));
    } else if (self->acceptor_.is_open()) {
      // The process is probably out of file descriptors. Sessions that end release some.
      self->pause_.expires_after(std::chrono::milliseconds(100));
      const auto [woken] = co_await self->pause_.async_wait(kTuple);
      (void)woken;
    }
  }
}

void Listener::admit_socket(asio::ip::tcp::socket socket) {
  asio::error_code gone;
  const AddressBlock from = address_block(socket.remote_endpoint(gone).address());
  if (gone) return;
  if (!make_place(from)) return refuse(socket);
  add(make_stream(std::move(socket)), from);
}

void Listener::admit(std::unique_ptr<ByteStream> stream) {
  asio::post(strand_, [self = shared_from_this(), stream = std::move(stream)]() mutable {
    const AddressBlock from = stream->address();
    if (self->make_place(from)) return self->add(std::move(stream), from);
    self->counters_.refused.fetch_add(1);
  });
}

bool Listener::make_place(AddressBlock from) {
  if (!connections_.take(from, 1, steady_now_us())) return false;
  std::optional<std::vector<std::shared_ptr<NetSession>>> ended;
  {
    const std::lock_guard lock(mutex_);
    ended = make_room(from);
  }
  if (!ended) return false;
  counters_.refused.fetch_add(ended->size());
  for (const auto& session : *ended) session->abort();
  return true;
}

void Listener::add(std::unique_ptr<ByteStream> stream, AddressBlock from) {
  counters_.connections.fetch_add(1);
  const SessionId id = next_id_++;
  auto session =
      std::make_shared<NetSession>(id, io_, decoders_, std::move(stream), limits_, chunk_edge_,
                                   budget_, reads_of(from), events_, counters_);
  {
    const std::lock_guard lock(mutex_);
    if (is_stopped_) return;
    sessions_.emplace(id, session);
    handshakes_.emplace(id, from);
    handshakes_from_[from].insert(id);
  }
  session->start();
}

void Listener::refuse(asio::ip::tcp::socket& socket) {
  counters_.refused.fetch_add(1);
  // A reset leaves nothing in the kernel. Otherwise each of these sockets would stay in TIME_WAIT.
  asio::error_code ignored;
  socket.set_option(asio::socket_base::linger(true, 0), ignored);
  socket.close(ignored);
}

std::shared_ptr<ByteBudget> Listener::reads_of(AddressBlock from) {
  if (reads_.size() > 2 * limits_.connections_max)
    std::erase_if(reads_, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<ByteBudget>& known = reads_[from];
  std::shared_ptr<ByteBudget> budget = known.lock();
  if (budget == nullptr) {
    budget = std::make_shared<ByteBudget>(limits_.read_bytes_per_address);
    known = budget;
  }
  return budget;
}

std::unique_ptr<ByteStream> Listener::make_stream(asio::ip::tcp::socket socket) {
  std::optional<TlsContext> tls;
  {
    const std::lock_guard lock(mutex_);
    tls = tls_;
  }
  if (!tls) return make_tcp_stream(std::move(socket), limits_.notsent_bytes, limits_.log_addresses);
  return make_tls_stream(std::move(socket), limits_.notsent_bytes, limits_.log_addresses, *tls,
                         decoders_, goodbye_to_plain_client());
}

std::optional<std::vector<std::shared_ptr<NetSession>>> Listener::make_room(AddressBlock from) {
  if (leaving_.size() >= kLeavingMax) return std::nullopt;
  std::vector<std::shared_ptr<NetSession>> ended;
  const auto end = [&](SessionId oldest) {
    ended.push_back(sessions_.at(oldest));
    end_handshake(oldest);
    leaving_.insert(oldest);
  };
  const auto same = handshakes_from_.find(from);
  if (same != handshakes_from_.end() && same->second.size() >= limits_.handshakes_per_address) {
    end(*same->second.begin());
  }
  if (sessions_.size() - leaving_.size() >= limits_.connections_max) {
    if (handshakes_.empty()) return std::nullopt;  // all connections have authenticated
    end(handshakes_.begin()->first);
  }
  return ended;
}

void Listener::end_handshake(SessionId session) {
  const auto found = handshakes_.find(session);
  if (found == handshakes_.end()) return;
  const auto from = handshakes_from_.find(found->second);
  from->second.erase(session);
  if (from->second.empty()) handshakes_from_.erase(from);
  handshakes_.erase(found);
}

void Listener::opened(SessionId session) {
  const std::lock_guard lock(mutex_);
  end_handshake(session);
  const auto found = sessions_.find(session);
  if (found != sessions_.end()) found->second->authenticated();
}

std::shared_ptr<NetSession> Listener::find(SessionId session) const {
  const std::lock_guard lock(mutex_);
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? nullptr : found->second;
}

void Listener::forget(SessionId session) {
  std::shared_ptr<NetSession> ended;
  {
    const std::lock_guard lock(mutex_);
    end_handshake(session);
    leaving_.erase(session);
    const auto found = sessions_.find(session);
    if (found == sessions_.end()) return;
    ended = std::move(found->second);
    sessions_.erase(found);
  }
  if (!is_broken_rule(ended->end().reason)) return;
  const auto charge = [self = shared_from_this(), from = ended->address()] {
    self->connections_.charge(from, self->limits_.connections_per_second, steady_now_us());
  };
  asio::post(strand_, charge);
}

SendRound Listener::begin_round(const EncodedMessage& message) {
  return {io_, counters_, message.kind == kKindOf<Commit>};
}

void Listener::close_stalled(TimeUs now_us, TimeUs us_max) {
  std::vector<std::shared_ptr<NetSession>> stalled;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, session] : sessions_) {
      if (session->write_us(now_us) >= us_max) stalled.push_back(session);
    }
  }
  for (const auto& session : stalled)
    session->close(GoodbyeReason::timed_out, "the client does not read");
}

std::size_t Listener::session_count() const {
  const std::lock_guard lock(mutex_);
  return sessions_.size();
}

void Listener::close_all(GoodbyeReason reason, const std::string& text) {
  std::vector<std::shared_ptr<NetSession>> sessions;
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    for (const auto& [id, session] : sessions_) sessions.push_back(session);
  }
  for (const auto& session : sessions) session->close(reason, text);
}

}  // namespace runstone
