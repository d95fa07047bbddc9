#include "server/net/connecting_stream.hpp"

#include <asio/steady_timer.hpp>
#include <asio/this_coro.hpp>
#include <utility>

#include "server/net/await_tuple.hpp"

namespace runstone {

/// A name that is being resolved. The system cannot interrupt that, so nobody waits for it after
/// close(), and its answer is dropped.
struct ConnectingStream::Lookup {
  explicit Lookup(const asio::any_io_executor& strand) : resolver(strand), ended(strand) {
    ended.expires_at(asio::steady_timer::time_point::max());
  }
  asio::ip::tcp::resolver resolver;
  asio::steady_timer ended;  // never expires; cancelled at the end
  asio::error_code error;
  asio::ip::tcp::resolver::results_type found;
};

ConnectingStream::ConnectingStream(HostPort server, std::optional<TlsContext> tls,
                                   std::size_t notsent_bytes, asio::any_io_executor handshakes,
                                   std::chrono::milliseconds time)
    : server_(std::move(server)),
      tls_(std::move(tls)),
      notsent_bytes_(notsent_bytes),
      handshakes_(std::move(handshakes)),
      time_(time) {}

ConnectingStream::~ConnectingStream() = default;

asio::awaitable<StreamStart> ConnectingStream::open() {
  const bool is_resolved = co_await resolve();
  if (!is_resolved) co_return StreamStart::failed;
  const bool is_connected = co_await connect();
  if (!is_connected) co_return StreamStart::failed;
  Socket socket = std::move(*attempt_);
  attempt_.reset();
  lookup_.reset();
  stream_ = tls_ ? make_tls_client_stream(std::move(socket), notsent_bytes_, AddressForm::full,
                                          *tls_, server_.host, handshakes_)
                 : make_tcp_stream(std::move(socket), notsent_bytes_, AddressForm::full);
  const StreamStart started = co_await stream_->open();
  if (started != StreamStart::open) fail_open("TLS: " + stream_->failure());
  co_return started;
}

asio::awaitable<bool> ConnectingStream::resolve() {
  const asio::any_io_executor strand = co_await asio::this_coro::executor;
  lookup_ = std::make_shared<Lookup>(strand);
  lookup_->resolver.async_resolve(server_.host, std::to_string(server_.port),
                                  [lookup = lookup_](const asio::error_code& error,
                                                     asio::ip::tcp::resolver::results_type found) {
                                    lookup->error = error;
                                    lookup->found = std::move(found);
                                    lookup->ended.cancel();
                                  });
  const auto [cancelled] = co_await lookup_->ended.async_wait(kTuple);
  (void)cancelled;  // by the answer or by close()
  if (!lookup_->found.empty() && !is_closed_) co_return true;
  fail_open("cannot resolve " + server_.host + ": " +
            (lookup_->error ? lookup_->error.message() : "it took too long"));
  co_return false;
}

asio::awaitable<bool> ConnectingStream::connect() {
  const asio::any_io_executor strand = co_await asio::this_coro::executor;
  asio::steady_timer timer(strand);
  const auto share = time_ / static_cast<std::int64_t>(lookup_->found.size());
  asio::error_code last;
  for (const auto& address : lookup_->found) {
    attempt_ = std::make_shared<Socket>(strand);
    timer.expires_after(share);
    timer.async_wait([socket = attempt_](const asio::error_code& cancelled) {
      asio::error_code ignored;
      if (!cancelled) socket->close(ignored);
    });
    const asio::ip::tcp::endpoint endpoint = address.endpoint();
    const auto [error] = co_await attempt_->async_connect(endpoint, kTuple);
    timer.cancel();
    last = error;
    // The timer or close() may have closed the socket after it was connected.
    if (!last && !attempt_->is_open()) last = asio::error::operation_aborted;
    if (!last || is_closed_) break;
  }
  if (!last) co_return true;
  const bool is_late = last == asio::error::operation_aborted;
  fail_open("cannot connect: " + (is_late ? "it took too long" : last.message()));
  co_return false;
}

StreamStart ConnectingStream::fail_open(std::string why) {
  failure_ = std::move(why);
  return StreamStart::failed;
}

void ConnectingStream::close() {
  is_closed_ = true;
  asio::error_code ignored;
  if (lookup_) lookup_->ended.cancel();
  if (attempt_) attempt_->close(ignored);
  if (stream_) stream_->close();
}

}  // namespace runstone
