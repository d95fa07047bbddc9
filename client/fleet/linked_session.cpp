#include "client/fleet/linked_session.hpp"

#include <spdlog/spdlog.h>

#include <type_traits>
#include <utility>

#include "client/net/key_file.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {

template <class Session>
LinkedSession<Session>::LinkedSession(asio::io_context& io, Session& session,
                                      const std::string& name, const LinkConfig& net)
    : session_(session), name_(name), link_(io, net, *this) {
  link_.start();
}

template <class Session>
void LinkedSession<Session>::flush() {
  for (const Message& message : session_.take_outgoing())
    link_.send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) link_.close(connection_);
}

template <class Session>
void LinkedSession<Session>::leave(std::int64_t milliseconds) {
  session_.close(GoodbyeReason::closing, "");
  flush();
  link_.stop(milliseconds);
}

template <class Session>
void LinkedSession<Session>::on_connected(ConnectionNumber connection,
                                          const std::optional<ChannelBinding>& binding) {
  connection_ = connection;
  session_.connected(random_nonce(), binding, steady_now_us(), link_.attempt().is_listed);
  flush();
}

template <class Session>
void LinkedSession<Session>::on_received(LinkReceived received) {
  const TimeUs now_us = steady_now_us();
  session_.receive(std::move(received.message),
                   {received.received_us, received.unpacked_us, now_us});
  if (std::exchange(servers_seen_, session_.servers_number()) != session_.servers_number())
    link_.set_servers(session_.servers());
  flush();
}

template <class Session>
Result<bool> LinkedSession<Session>::on_bytes(MessageKind kind, ByteView body,
                                              std::uint16_t chunk_edge, TimeUs received_us) {
  if constexpr (std::is_same_v<Session, HeadlessSession>) {
    return session_.receive_bytes(kind, body, chunk_edge, received_us);
  } else {
    return LinkCallbacks::on_bytes(kind, body, chunk_edge, received_us);
  }
}

template <class Session>
void LinkedSession<Session>::on_disconnected(ConnectionNumber /*connection*/, std::string why) {
  connection_ = 0;
  const bool is_expected = session_.wants_close() && !session_.end();
  session_.disconnected();
  last_failure_ = std::move(why);
  if (session_.end() && !session_.end()->text.empty())
    last_failure_ += " (" + session_.end()->text + ")";
  if (!is_expected) ++losses_[last_failure_];
  spdlog::debug("{}: {}", name_, last_failure_);
}

template class LinkedSession<ClientSession>;
template class LinkedSession<HeadlessSession>;

}  // namespace runstone
