#include "client/app/session_link.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "client/net/key_file.hpp"
#include "client/net/steady_clock.hpp"

namespace runstone {

SessionLink::SessionLink(asio::io_context& io, ClientSession& session, const std::string& name,
                         const NetConfig& net)
    : session_(session), name_(name), link_(io, net, *this) {
  link_.start();
}

void SessionLink::flush() {
  for (const Message& message : session_.take_outgoing()) link_.send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) link_.close(connection_);
}

void SessionLink::leave(std::int64_t milliseconds) {
  session_.close(GoodbyeReason::closing, "");
  flush();
  link_.stop(milliseconds);
}

void SessionLink::on_connected(ConnectionNumber connection) {
  connection_ = connection;
  session_.connected(random_nonce(), steady_now_us());
  flush();
}

void SessionLink::on_received(NetReceived received) {
  const TimeUs now_us = steady_now_us();
  session_.receive(std::move(received.message), {received.received_us, received.unpacked_us, now_us});
  flush();
}

void SessionLink::on_disconnected(ConnectionNumber /*connection*/, std::string why) {
  connection_ = 0;
  session_.disconnected();
  last_failure_ = std::move(why);
  if (session_.end() && !session_.end()->text.empty()) last_failure_ += " (" + session_.end()->text + ")";
  spdlog::debug("{}: {}", name_, last_failure_);
}

}  // namespace runstone
