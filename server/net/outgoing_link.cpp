#include "server/net/outgoing_link.hpp"

#include <utility>
#include <variant>

#include "common/core/assert.hpp"
#include "server/net/connecting_stream.hpp"

namespace runstone {
namespace {

// A link has one session, and its number is only seen in log lines.
constexpr SessionId kLinkSession = 0;

}  // namespace

OutgoingLink::OutgoingLink(asio::io_context& io, asio::any_io_executor decoders,
                           std::uint16_t chunk_edge, std::optional<TlsContext> tls, Events events)
    : io_(io),
      decoders_(std::move(decoders)),
      chunk_edge_(chunk_edge),
      tls_(std::move(tls)),
      events_(std::move(events)) {
  RUNSTONE_ASSERT(events_.on_connected && events_.on_message && events_.on_ended);
}

void OutgoingLink::connect(const HostPort& server, std::chrono::milliseconds time) {
  limits_.handshake_ms = time.count();
  auto stream =
      std::make_unique<ConnectingStream>(server, tls_, limits_.notsent_bytes, decoders_, time);
  // This pointer to a member shares the ownership of the link, so the link lives as long as its session.
  std::shared_ptr<ByteBudget> reads(shared_from_this(), &no_budget_);
  NetEvents& events = *this;
  auto session = std::make_shared<NetSession>(kLinkSession, io_, decoders_, std::move(stream),
                                              limits_, chunk_edge_, no_budget_, std::move(reads),
                                              events, counters_, Sender::server);
  session_ = session;
  session->start();
}

bool OutgoingLink::send(const EncodedMessage& message) {
  if (!is_connected_) return false;
  const auto session = session_.lock();
  return session == nullptr || session->send(message);
}

void OutgoingLink::handled(std::size_t bytes) {
  if (const auto session = session_.lock()) session->handled(bytes);
}

void OutgoingLink::close(const std::string& why) {
  if (const auto session = session_.lock()) session->close(GoodbyeReason::closing, why);
}

void OutgoingLink::on_refused(SessionId /*session*/) { report_end(); }

void OutgoingLink::on_connected(SessionId /*session*/,
                                const std::optional<ChannelBinding>& binding) {
  is_connected_ = true;
  events_.on_connected(binding);
}

void OutgoingLink::on_message(SessionId /*session*/, Message&& message, std::size_t bytes) {
  if (auto* goodbye = std::get_if<Goodbye>(&message)) {
    if (!goodbye_) goodbye_ = std::move(*goodbye);
    return handled(bytes);
  }
  events_.on_message(std::move(message), bytes);
}

void OutgoingLink::on_disconnected(SessionId /*session*/) { report_end(); }

void OutgoingLink::report_end() {
  const auto session = session_.lock();
  const EndCause end = session->end();
  std::string why = end.text;
  if (goodbye_) {
    why = "the server said goodbye: " + goodbye_->text;
  } else if (is_broken_rule(end.reason)) {
    why = "bad bytes from the server: " + end.text;
  }
  // The events may hold the link, and the link must not hold them any more then.
  const Events events = std::exchange(events_, {});
  events.on_ended(why);
}

}  // namespace runstone
