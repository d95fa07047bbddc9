#include <asio/bind_executor.hpp>
#include <asio/error.hpp>
#include <asio/post.hpp>
#include <asio/this_coro.hpp>
#include <atomic>
#include <utility>

#include "common/os/thread_cpu_ns.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/tcp_stream.hpp"

namespace runstone {
namespace {

constexpr auto kCanRead = asio::ip::tcp::socket::wait_read;
/// The first byte of a TLS connection: a record of the type handshake (RFC 8446, 5.1). A client that
/// does not speak TLS begins with the size of its Hello, which is neither 22 nor 278 bytes.
constexpr std::uint8_t kHandshakeRecord = 22;
/// What a step of the handshake reads at most. An honest client's has two or three steps.
constexpr std::size_t kHandshakeBytes = 4 * 1024;
constexpr unsigned kHandshakeStepsMax = 32;
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

class TlsStream final : public ByteStream {
 public:
  TlsStream(asio::ip::tcp::socket socket, std::size_t notsent_bytes, AddressForm log_form,
            const TlsContext& context, asio::any_io_executor handshakes, Bytes plain_answer)
      : tcp_(std::move(socket), notsent_bytes, log_form),
        source_(tcp_.socket().native_handle()),
        context_(context),
        handshakes_(std::move(handshakes)),
        plain_answer_(std::move(plain_answer)) {}

  asio::awaitable<StreamStart> open() override {
    const asio::any_io_executor strand = co_await asio::this_coro::executor;
    for (unsigned step = 0; step < kHandshakeStepsMax; ++step) {
      const auto [error] = co_await tcp_.socket().async_wait(kCanRead, kTuple);
      if (error || !tcp_.socket().is_open()) {
        failure_ = "it was closed or took too long";
        co_return StreamStart::failed;
      }
      if (!channel_) {
        asio::error_code missing;
        const std::uint8_t first = first_byte(missing);
        if (missing == asio::error::would_block) continue;
        if (missing) {
          failure_ = "it was closed before its first byte";
          co_return StreamStart::failed;
        }
        if (first != kHandshakeRecord) {
          co_await answer_plain();
          co_return StreamStart::not_encrypted;
        }
        // A connection that sends nothing costs no memory of TLS.
        channel_.emplace(TlsChannel::accept(context_, source_));
      }
      source_.hold(kHandshakeBytes);
      co_await asio::post(asio::bind_executor(handshakes_, asio::use_awaitable));
      // Many may wait for a thread here. Those that were closed meanwhile cost no signature.
      const TlsChannel::Status status =
          is_closed_ ? TlsChannel::Status::failed : channel_->handshake();
      co_await asio::post(asio::bind_executor(strand, asio::use_awaitable));
      source_.release();
      co_await flush();
      if (status == TlsChannel::Status::done) {
        plain_answer_ = {};
        binding_ = channel_->binding();
        co_return StreamStart::open;
      }
      const asio::error_code broken = is_closed_ ? asio::error::operation_aborted : source_broke();
      if (status != TlsChannel::Status::wants_input || broken) {
        failure_ = broken ? broken.message() : channel_->error();
        co_return StreamStart::failed;
      }
    }
    failure_ = "it came in too many pieces";
    co_return StreamStart::failed;
  }
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

  asio::awaitable<IoResult> write(const std::vector<asio::const_buffer>& buffers,
                                  std::size_t terrain_bytes) override {
    IoResult result;
    const std::int64_t began_ns = thread_cpu_ns();
    Bytes& records = channel_->output();
    if (records.empty()) records.swap(scratch.records);
    if (!encrypt(buffers, asio::buffer_size(buffers) - terrain_bytes)) {
      result.error = asio::error::connection_aborted;
      co_return result;
    }
    // Most writes end here.
    result.bytes = tcp_.socket().write_some(asio::buffer(records), result.error);
    result.call_ns = thread_cpu_ns() - began_ns;
    if (result.bytes == records.size()) {
      records.clear();
      records.swap(scratch.records);
      co_return result;
    }
    if (result.error && result.error != asio::error::would_block) co_return result;
    records.erase(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(result.bytes));
    const IoResult rest = co_await flush();
    result.error = rest.error;
    result.bytes += rest.bytes;
    result.call_ns += rest.call_ns;
    co_return result;
  }

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

 private:
  /// Returns the first byte of the connection and leaves it where it is. At the end of the stream it
  /// sets the error eof.
  std::uint8_t first_byte(asio::error_code& error) {
    std::uint8_t first = 0;
    tcp_.socket().receive(asio::buffer(&first, 1), asio::socket_base::message_peek, error);
    return first;
  }
  asio::awaitable<void> answer_plain() {
    buffers_.assign(1, asio::buffer(plain_answer_));
    co_await tcp_.write(buffers_, 0);
    tcp_.shutdown_send();
    Bytes buffer(1024);
    for (std::size_t got = 0; got < kPlainBytes;) {
      const IoResult read = co_await tcp_.read_some(asio::buffer(buffer));
      if (read.error) break;
      got += read.bytes;
    }
  }
  asio::error_code source_broke() const {
    if (source_.is_at_end()) return asio::error::eof;
    return source_.error();
  }
  /// Terrain begins a record of its own, so that the peer can read an edit before the terrain
  /// behind it has arrived.
  bool encrypt(const std::vector<asio::const_buffer>& buffers, std::size_t before_terrain) {
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
    buffers_.assign(1, asio::buffer(sending_));
    const IoResult result = co_await tcp_.write(buffers_, 0);
    sending_ = {};
    co_return result;
  }

  TcpStream tcp_;
  SocketSource source_;
  const TlsContext context_;
  std::optional<TlsChannel> channel_;  // from the first byte on
  const asio::any_io_executor handshakes_;
  Bytes plain_answer_;
  Bytes sending_;
  std::vector<asio::const_buffer> buffers_;  // of the write under way
  std::atomic<bool> is_closed_{false};       // read by a thread of handshakes_
  std::optional<ChannelBinding> binding_;
  std::string failure_;
};

}  // namespace

std::unique_ptr<ByteStream> make_tls_stream(asio::ip::tcp::socket socket, std::size_t notsent_bytes,
                                            AddressForm log_form, const TlsContext& context,
                                            asio::any_io_executor handshakes, Bytes plain_answer) {
  return std::make_unique<TlsStream>(std::move(socket), notsent_bytes, log_form, context,
                                     std::move(handshakes), std::move(plain_answer));
}

}  // namespace runstone
