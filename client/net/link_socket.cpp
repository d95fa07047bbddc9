#include "client/net/link_socket.hpp"

#include <algorithm>
#include <asio/error.hpp>
#include <asio/experimental/as_tuple.hpp>
#include <asio/use_awaitable.hpp>
#include <asio/write.hpp>
#include <utility>

namespace runstone {
namespace {

constexpr auto kSocketTuple = asio::experimental::as_tuple(asio::use_awaitable);
constexpr std::size_t kReceiveBytes = kTlsRecordBytesMax + kTlsRecordExtraBytes;

/// Looks at the first byte of the server: the type of a record, handshake or alert (RFC 8446, 5.1).
bool is_handshake_record(std::uint8_t first) { return first == 22 || first == 21; }

}  // namespace

void LinkSocket::reset() {
  tls_.reset();
  binding_.reset();
  web_.reset();
  contents_.clear();
  contents_read_ = 0;
  is_ended_ = false;
  closing_words_.clear();
  tcp_ = asio::ip::tcp::socket(tcp_.get_executor());
}

void LinkSocket::set_no_delay() {
  asio::error_code ignored;
  tcp_.set_option(asio::ip::tcp::no_delay(true), ignored);
}

asio::awaitable<std::string> LinkSocket::secure(const TlsContext& context,
                                                const std::string& host) {
  records_.buffer.resize(kReceiveBytes);
  records_.unread = {};
  tls_.emplace(TlsChannel::connect(context, records_, host));
  for (bool is_first = true;;) {
    const TlsChannel::Status status = tls_->handshake();
    const asio::error_code unsent = co_await flush();
    if (status == TlsChannel::Status::done) break;
    if (status != TlsChannel::Status::wants_input) co_return "TLS: " + tls_->error();
    if (unsent) co_return "TLS: " + unsent.message();
    const asio::error_code ended = co_await receive();
    if (ended) co_return "TLS: " + ended.message();
    if (std::exchange(is_first, false) && !is_handshake_record(records_.unread.front()))
      co_return "the server does not speak TLS: does it run with --insecure?";
  }
  binding_ = tls_->binding();
  co_return std::string();
}

asio::awaitable<std::string> LinkSocket::open_websocket(const std::string& host,
                                                        const std::string& path) {
  WebSocketCodec codec;
  const std::string request = codec.request(host, path);
  const ByteView request_bytes(reinterpret_cast<const std::uint8_t*>(request.data()),
                               request.size());
  const asio::error_code unsent = co_await write_below(request_bytes);
  if (unsent) co_return "the gateway takes no request: " + unsent.message();
  received_.resize(kReceiveBytes);
  std::string answer;
  for (;;) {
    const Read got = co_await read_below(asio::buffer(received_));
    if (got.error) co_return "the gateway gives no answer: " + got.error.message();
    answer.append(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(got.bytes));
    const auto end = codec.read_answer(answer);
    if (!end) co_return end.error();
    if (*end == 0) continue;
    const Bytes rest(answer.begin() + static_cast<std::ptrdiff_t>(*end), answer.end());
    const auto read = codec.read(rest, contents_);
    // Messages that came before the close frame are read first.
    if (!read && contents_.empty()) co_return read.error();
    if (!read) end_reading(read.error());
    web_.emplace(std::move(codec));
    co_return std::string();
  }
}

asio::awaitable<LinkSocket::Read> LinkSocket::read_some(asio::mutable_buffer into) {
  if (!web_) {
    const Read plain = co_await read_below(into);
    co_return plain;
  }
  while (contents_read_ == contents_.size()) {
    if (is_ended_) co_return Read{asio::error::eof, 0};
    contents_.clear();
    contents_read_ = 0;
    const Read got = co_await read_below(asio::buffer(received_));
    if (got.error) co_return got;
    const auto read = web_->read(ByteView(received_).first(got.bytes), contents_);
    if (!read) end_reading(read.error());
  }
  const std::size_t bytes = std::min(into.size(), contents_.size() - contents_read_);
  std::copy_n(contents_.begin() + static_cast<std::ptrdiff_t>(contents_read_), bytes,
              static_cast<std::uint8_t*>(into.data()));
  contents_read_ += bytes;
  co_return Read{{}, bytes};
}

void LinkSocket::end_reading(const std::string& words) {
  closing_words_ = words;
  is_ended_ = true;
}

asio::awaitable<LinkSocket::Read> LinkSocket::read_below(asio::mutable_buffer into) {
  Read result;
  if (!tls_) {
    const auto [error, bytes] = co_await tcp_.async_read_some(into, kSocketTuple);
    co_return Read{error, bytes};
  }
  for (;;) {
    const TlsChannel::Status status =
        tls_->read({static_cast<std::uint8_t*>(into.data()), into.size()}, result.bytes);
    if (status == TlsChannel::Status::done) break;
    if (status != TlsChannel::Status::wants_input) {
      result.error = asio::error::eof;
      break;
    }
    result.error = co_await receive();
    if (result.error) break;
  }
  co_return result;
}

asio::awaitable<asio::error_code> LinkSocket::write(ByteView bytes) {
  if (web_) {
    messages_.clear();
    web_->write(bytes, messages_);
    bytes = messages_;
  }
  const asio::error_code error = co_await write_below(bytes);
  co_return error;
}

asio::awaitable<asio::error_code> LinkSocket::write_below(ByteView bytes) {
  if (!tls_) {
    const auto [error, count] =
        co_await asio::async_write(tcp_, asio::buffer(bytes.data(), bytes.size()), kSocketTuple);
    co_return error;
  }
  if (!tls_->write(bytes)) co_return asio::error::connection_aborted;
  const asio::error_code error = co_await flush();
  co_return error;
}

void LinkSocket::close() {
  if (!tcp_.is_open()) return;
  asio::error_code ignored;
  if (tls_ && binding_) {
    tls_->end();
    // What the kernel does not take at once is given up: the connection ends anyway.
    tcp_.non_blocking(true, ignored);
    tcp_.write_some(asio::buffer(tls_->output()), ignored);
  }
  tcp_.shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  tcp_.close(ignored);
}

asio::awaitable<asio::error_code> LinkSocket::flush() {
  // While the socket takes the bytes, a read may add to the output.
  sending_.clear();
  sending_.swap(tls_->output());
  const auto [error, count] = co_await asio::async_write(
      tcp_, asio::buffer(sending_.data(), sending_.size()), kSocketTuple);
  co_return error;
}

asio::awaitable<asio::error_code> LinkSocket::receive() {
  const auto [error, bytes] =
      co_await tcp_.async_read_some(asio::buffer(records_.buffer), kSocketTuple);
  records_.unread = ByteView(records_.buffer).first(bytes);
  co_return error;
}

std::size_t LinkSocket::Records::receive(std::span<std::uint8_t> into) {
  const std::size_t count = std::min(into.size(), unread.size());
  std::copy_n(unread.begin(), count, into.begin());
  unread = unread.subspan(count);
  return count;
}

}  // namespace runstone
