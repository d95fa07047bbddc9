#include <asio/bind_executor.hpp>
#include <asio/error.hpp>
#include <asio/post.hpp>
#include <asio/this_coro.hpp>
#include <asio/write.hpp>
#include <atomic>
#include <utility>

#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/tcp_stream.hpp"

namespace runstone {
namespace {

constexpr auto kCanRead = asio::ip::tcp::socket::wait_read;
/// The first byte of a TLS connection: a record of the type handshake (RFC 8446, 5.1), or alert if a
/// server refuses. A client that does not speak TLS begins with the size of its Hello, which is neither
/// 22 nor 278 bytes.
constexpr std::uint8_t kHandshakeRecord = 22, kAlertRecord = 21;
/// What a step of the handshake reads at most. An honest peer's has two or three steps.
constexpr std::size_t kHandshakeBytes = 4 * 1024;
constexpr unsigned kHandshakeStepsMax = 32;
constexpr const char* kClosedText = "it was closed or took too long";
/// What is read of a client that does not speak TLS. Unread input would make the kernel reset the
/// connection, and the answer would be lost.
constexpr std::size_t kPlainBytes = 16 * 1024;

/// Memory that the writes of a thread share, so that an idle connection has none and a write
/// allocates none.
struct Scratch {
  Bytes text, records;
};
thread_local Scratch scratch;

/// Text that is gathered for the next record.
class RecordText {
 public:
  explicit RecordText(TlsChannel& channel) : channel_(channel) { text_.clear(); }
  /// Writes a record whenever one is full. Returns false after a failure.
  bool add(ByteView text) {
    while (!text.empty()) {
      // A full record is not copied.
      if (text_.empty() && text.size() >= kTlsRecordBytesMax) {
        if (!channel_.write(text.first(kTlsRecordBytesMax))) return false;
        text = text.subspan(kTlsRecordBytesMax);
        continue;
      }
      const std::size_t taken = std::min(text.size(), kTlsRecordBytesMax - text_.size());
      text_.insert(text_.end(), text.begin(), text.begin() + static_cast<std::ptrdiff_t>(taken));
      text = text.subspan(taken);
      if (text_.size() == kTlsRecordBytesMax && !end()) return false;
    }
    return true;
  }
  /// Writes what was gathered.
  bool end() {
    const bool written = channel_.write(text_);
    text_.clear();
    return written;
  }

 private:
  TlsChannel& channel_;
  Bytes& text_ = scratch.text;
};

/// Either end after the handshake. The two ends differ in open() only.
class TlsStream : public ByteStream {
 public:
  TlsStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form,
            const TlsContext& context, asio::any_io_executor handshakes)
      : tcp_(std::move(socket), notsent_bytes, log_form),
        source_(tcp_.socket().native_handle()),
        context_(context),
        handshakes_(std::move(handshakes)) {}

  std::string failure() const override { return failure_; }
  std::optional<ChannelBinding> binding() const override { return binding_; }

  asio::awaitable<IoResult> read_some(asio::mutable_buffer into) override {
    IoResult result;
    // A record holds its text and a little more. More than two buffers without text are no mistake.
    source_.allow(2 * into.size() + kTlsRecordExtraBytes);
    for (;;) {
      const TlsChannel::Status status =
          channel_->read({static_cast<std::uint8_t*>(into.data()), into.size()}, result.bytes);
      result.received += source_.take_count();
      if (status == TlsChannel::Status::done) break;
      result.error = status == TlsChannel::Status::wants_input ? source_broke() : asio::error::eof;
      if (result.error || source_.is_used_up()) break;
      const auto [error] = co_await tcp_.socket().async_wait(kCanRead, kTuple);
      result.error = error;
      if (error) break;
    }
    co_return result;
  }

  IoResult write_now(std::span<const asio::const_buffer> buffers,
                     std::size_t terrain_bytes) override {
    IoResult result;
    Bytes& records = channel_->output();
    if (records.empty()) records.swap(scratch.records);
    if (!encrypt(buffers, asio::buffer_size(buffers) - terrain_bytes)) {
      result.error = asio::error::connection_aborted;
      return result;
    }
    result.bytes = tcp_.socket().write_some(asio::buffer(records), result.error);
    if (result.bytes == records.size()) {
      records.clear();
      records.swap(scratch.records);
      return result;
    }
    if (result.error == asio::error::would_block) result.error = {};
    if (result.error) return result;
    records.erase(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(result.bytes));
    result.has_rest = true;
    return result;
  }
  asio::awaitable<IoResult> write_rest() override { return flush(); }

  StreamRoom room() override {
    StreamRoom room = tcp_.room();
    const std::size_t records = room.bytes / kTlsRecordBytesMax + 1;
    room.bytes -= std::min(room.bytes, records * kTlsRecordExtraBytes);
    return room;
  }
  void shutdown_send() override {
    channel_->end();
    // What the kernel does not take at once is given up: the peer does not read.
    asio::error_code ignored;
    tcp_.socket().write_some(asio::buffer(channel_->output()), ignored);
    tcp_.shutdown_send();
  }
  void close() override {
    is_closed_ = true;
    source_.disconnect();
    tcp_.close();
  }
  std::string peer() const override { return tcp_.peer(); }
  AddressBlock address() const override { return tcp_.address(); }

 protected:
  // The functions that open() needs. Each sets failure_ before it reports a failure.

  StreamStart fail_open(std::string why) {
    failure_ = std::move(why);
    return StreamStart::failed;
  }
  /// Waits for bytes of the peer. Returns false if the stream was closed.
  asio::awaitable<bool> wait_input() {
    const auto [error] = co_await tcp_.socket().async_wait(kCanRead, kTuple);
    if (!error && tcp_.socket().is_open()) co_return true;
    fail_open(kClosedText);
    co_return false;
  }
  /// Waits for the first byte of the connection, returns it and leaves it where it is. Returns nullopt
  /// after a failure.
  asio::awaitable<std::optional<std::uint8_t>> first_byte() {
    for (;;) {
      const bool has_input = co_await wait_input();
      if (!has_input) co_return std::nullopt;
      std::uint8_t first = 0;
      asio::error_code missing;
      tcp_.socket().receive(asio::buffer(&first, 1), asio::socket_base::message_peek, missing);
      if (!missing) co_return first;
      if (missing == asio::error::would_block) continue;
      fail_open("it was closed before its first byte");
      co_return std::nullopt;
    }
  }
  /// Continues the handshake with what has arrived, and sends the output. Returns how the handshake
  /// ended, or nullopt if it needs more input.
  asio::awaitable<std::optional<StreamStart>> continue_handshake() {
    const asio::any_io_executor strand = co_await asio::this_coro::executor;
    source_.hold(kHandshakeBytes);
    co_await asio::post(asio::bind_executor(handshakes_, asio::use_awaitable));
    // Many may wait for a thread here. Those that were closed meanwhile cost no signature.
    const TlsChannel::Status status =
        is_closed_ ? TlsChannel::Status::failed : channel_->handshake();
    co_await asio::post(asio::bind_executor(strand, asio::use_awaitable));
    source_.release();
    co_await flush();
    if (status == TlsChannel::Status::done) {
      binding_ = channel_->binding();
      co_return StreamStart::open;
    }
    if (is_closed_) co_return fail_open(kClosedText);
    const asio::error_code broken = source_broke();
    if (status == TlsChannel::Status::wants_input && !broken) co_return std::nullopt;
    co_return fail_open(broken ? broken.message() : channel_->error());
  }
  /// Continues the handshake, for which input has arrived, to its end.
  asio::awaitable<StreamStart> finish_handshake() {
    for (unsigned step = 0; step < kHandshakeStepsMax; ++step) {
      if (step > 0) {
        const bool has_input = co_await wait_input();
        if (!has_input) co_return StreamStart::failed;
      }
      const std::optional<StreamStart> end = co_await continue_handshake();
      if (end) co_return *end;
    }
    co_return fail_open("it came in too many pieces");
  }

  TcpStream tcp_;
  SocketSource source_;
  const TlsContext context_;
  std::optional<TlsChannel> channel_;

 private:
  asio::error_code source_broke() const {
    if (source_.is_at_end()) return asio::error::eof;
    return source_.error();
  }
  /// Terrain begins a record of its own, so that the peer can read an edit before the terrain
  /// behind it has arrived.
  bool encrypt(std::span<const asio::const_buffer> buffers, std::size_t before_terrain) {
    RecordText record(*channel_);
    std::size_t at = 0;
    for (const asio::const_buffer& buffer : buffers) {
      if (at == before_terrain && !record.end()) return false;
      if (!record.add({static_cast<const std::uint8_t*>(buffer.data()), buffer.size()}))
        return false;
      at += buffer.size();
    }
    return record.end();
  }
  /// Sends the output of the channel.
  asio::awaitable<IoResult> flush() {
    // While the socket takes the bytes, a read may add to the output.
    sending_.swap(channel_->output());
    const auto [error, bytes] =
        co_await asio::async_write(tcp_.socket(), asio::buffer(sending_), kTuple);
    sending_ = {};
    IoResult result;
    result.error = error;
    result.bytes = bytes;
    co_return result;
  }

  const asio::any_io_executor handshakes_;
  Bytes sending_;
  std::atomic<bool> is_closed_{false};  // read by a thread of handshakes_
  std::optional<ChannelBinding> binding_;
  std::string failure_;
};

class TlsServerStream final : public TlsStream {
 public:
  TlsServerStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form,
                  const TlsContext& context, asio::any_io_executor handshakes, Bytes plain_answer)
      : TlsStream(std::move(socket), notsent_bytes, log_form, context, std::move(handshakes)),
        plain_answer_(std::move(plain_answer)) {}

  asio::awaitable<StreamStart> open() override {
    const std::optional<std::uint8_t> first = co_await first_byte();
    if (!first) co_return StreamStart::failed;
    if (*first != kHandshakeRecord) {
      co_await answer_plain();
      co_return StreamStart::not_encrypted;
    }
    plain_answer_ = {};
    // A connection that sends nothing costs no memory of TLS.
    channel_.emplace(TlsChannel::accept(context_, source_));
    const StreamStart end = co_await finish_handshake();
    co_return end;
  }

 private:
  asio::awaitable<void> answer_plain() {
    const auto [unsent, sent] =
        co_await asio::async_write(tcp_.socket(), asio::buffer(plain_answer_), kTuple);
    if (unsent || sent < plain_answer_.size()) co_return;
    tcp_.shutdown_send();
    Bytes buffer(1024);
    for (std::size_t got = 0; got < kPlainBytes;) {
      const IoResult read = co_await tcp_.read_some(asio::buffer(buffer));
      if (read.error) break;
      got += read.bytes;
    }
  }

  Bytes plain_answer_;
};

class TlsClientStream final : public TlsStream {
 public:
  TlsClientStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form,
                  const TlsContext& context, const std::string& host,
                  asio::any_io_executor handshakes)
      : TlsStream(std::move(socket), notsent_bytes, log_form, context, std::move(handshakes)) {
    channel_.emplace(TlsChannel::connect(context_, source_, host));
  }

  asio::awaitable<StreamStart> open() override {
    // The client speaks first.
    const std::optional<StreamStart> end = co_await continue_handshake();
    if (end) co_return *end;
    const std::optional<std::uint8_t> first = co_await first_byte();
    if (!first) co_return StreamStart::failed;
    if (*first != kHandshakeRecord && *first != kAlertRecord)
      co_return fail_open("the server does not speak TLS");
    const StreamStart answered = co_await finish_handshake();
    co_return answered;
  }
};

}  // namespace

std::unique_ptr<ByteStream> make_tls_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form, const TlsContext& context,
                                            asio::any_io_executor handshakes, Bytes plain_answer) {
  return std::make_unique<TlsServerStream>(std::move(socket), notsent_bytes, log_form, context,
                                           std::move(handshakes), std::move(plain_answer));
}

std::unique_ptr<ByteStream> make_tls_client_stream(asio::ip::tcp::socket socket,
                                                   std::size_t notsent_bytes, AddressForm log_form,
                                                   const TlsContext& context,
                                                   const std::string& host,
                                                   asio::any_io_executor handshakes) {
  return std::make_unique<TlsClientStream>(std::move(socket), notsent_bytes, log_form, context,
                                           host, std::move(handshakes));
}

}  // namespace runstone
