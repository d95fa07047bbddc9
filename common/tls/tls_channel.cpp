#include "common/tls/tls_channel.hpp"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <climits>
#include <string_view>
#include <utility>

#include "common/core/assert.hpp"
#include "common/tls/openssl_error.hpp"
#include "common/tls/openssl_ptr.hpp"

namespace runstone {

struct TlsChannel::State {
  explicit State(TlsSource& bytes) : source(bytes) {}
  TlsSource& source;
  Bytes output;
  std::string error;
  unsigned key_updates = 0;  // of the peer
  OpensslPtr<SSL, SSL_free> ssl;
};

namespace {

constexpr std::string_view kExporterLabel = "EXPORTER-Channel-Binding";  // RFC 9266
// A peer may ask for new keys (RFC 8446, 4.6.3). Answering costs 20 us and 27 bytes, as often as it
// likes. Honest peers ask after millions of records, if ever.
constexpr unsigned kKeyUpdatesMax = 32;

// A BIO is OpenSSL's stream of bytes. Its data are a source and an output of a channel.
struct BioEnds {
  TlsSource* source;
  Bytes* output;
};

int bio_read(BIO* bio, char* into, int size) {
  BIO_clear_retry_flags(bio);
  if (size <= 0) return 0;
  auto* const ends = static_cast<BioEnds*>(BIO_get_data(bio));
  const std::size_t got = ends->source->receive(
      {reinterpret_cast<std::uint8_t*>(into), static_cast<std::size_t>(size)});
  if (got > 0) return static_cast<int>(got);
  BIO_set_retry_read(bio);
  return -1;
}

int bio_write(BIO* bio, const char* from, int size) {
  BIO_clear_retry_flags(bio);
  auto* const ends = static_cast<BioEnds*>(BIO_get_data(bio));
  ends->output->insert(ends->output->end(), from, from + std::max(size, 0));
  return size;
}

long bio_control(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

void count_key_updates(int is_sent, int /*version*/, int content, const void* message,
                       std::size_t bytes, SSL* /*ssl*/, void* count) {
  if (is_sent != 0 || content != SSL3_RT_HANDSHAKE || bytes == 0) return;
  if (*static_cast<const std::uint8_t*>(message) == SSL3_MT_KEY_UPDATE)
    ++*static_cast<unsigned*>(count);
}

int bio_destroy(BIO* bio) {
  delete static_cast<BioEnds*>(BIO_get_data(bio));
  return 1;
}

const BIO_METHOD* bio_method() {
  static const BIO_METHOD* const method = [] {
    BIO_METHOD* made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "runstone");
    RUNSTONE_ASSERT(made != nullptr);
    BIO_meth_set_read(made, bio_read);
    BIO_meth_set_write(made, bio_write);
    BIO_meth_set_ctrl(made, bio_control);
    BIO_meth_set_destroy(made, bio_destroy);
    return made;
  }();
  return method;
}

}  // namespace

TlsChannel::TlsChannel(std::unique_ptr<State> state) : state_(std::move(state)) {}
TlsChannel::~TlsChannel() = default;
TlsChannel::TlsChannel(TlsChannel&&) noexcept = default;
TlsChannel& TlsChannel::operator=(TlsChannel&&) noexcept = default;

TlsChannel TlsChannel::open(const TlsContext& context, TlsSource& source) {
  auto state = std::make_unique<State>(source);
  state->ssl.reset(SSL_new(context.get()));
  BIO* const bio = BIO_new(bio_method());
  RUNSTONE_ASSERT(state->ssl != nullptr && bio != nullptr);
  BIO_set_data(bio, new BioEnds{&source, &state->output});
  SSL_set_msg_callback(state->ssl.get(), count_key_updates);
  SSL_set_msg_callback_arg(state->ssl.get(), &state->key_updates);
  BIO_set_init(bio, 1);
  SSL_set_bio(state->ssl.get(), bio, bio);  // the channel owns the BIO
  return TlsChannel(std::move(state));
}

TlsChannel TlsChannel::accept(const TlsContext& context, TlsSource& source) {
  TlsChannel channel = open(context, source);
  SSL_set_accept_state(channel.state_->ssl.get());
  return channel;
}

TlsChannel TlsChannel::connect(const TlsContext& context, TlsSource& source,
                               const std::string& host) {
  TlsChannel channel = open(context, source);
  SSL* const ssl = channel.state_->ssl.get();
  SSL_set_connect_state(ssl);
  X509_VERIFY_PARAM* const expected = SSL_get0_param(ssl);
  const bool is_address = X509_VERIFY_PARAM_set1_ip_asc(expected, host.c_str()) == 1;
  if (!is_address) {
    // Without a name none would be compared with the certificate.
    RUNSTONE_ASSERT(!host.empty() && SSL_set1_host(ssl, host.c_str()) == 1);
    SSL_set_tlsext_host_name(ssl, host.c_str());
  }
  ERR_clear_error();
  return channel;
}

TlsChannel::Status TlsChannel::status_of(int result) {
  const int reason = SSL_get_error(state_->ssl.get(), result);
  if (reason == SSL_ERROR_WANT_READ) return Status::wants_input;
  if (reason == SSL_ERROR_ZERO_RETURN) return Status::ended;
  const long verified = SSL_get_verify_result(state_->ssl.get());
  const bool is_refused =
      SSL_get_verify_mode(state_->ssl.get()) != SSL_VERIFY_NONE && verified != X509_V_OK;
  const std::string error = take_openssl_error("the connection broke");
  state_->error =
      is_refused ? std::string("certificate: ") + X509_verify_cert_error_string(verified) : error;
  return Status::failed;
}

TlsChannel::Status TlsChannel::handshake() {
  ERR_clear_error();  // SSL_get_error() also looks at errors of other channels
  const int result = SSL_do_handshake(state_->ssl.get());
  return result == 1 ? Status::done : status_of(result);
}

TlsChannel::Status TlsChannel::read(std::span<std::uint8_t> into, std::size_t& bytes) {
  ERR_clear_error();
  const int result = SSL_read_ex(state_->ssl.get(), into.data(), into.size(), &bytes);
  if (state_->key_updates > kKeyUpdatesMax) {
    state_->error = "the peer changes its keys too often";
    return Status::failed;
  }
  return result == 1 ? Status::done : status_of(result);
}

bool TlsChannel::write(ByteView text) {
  if (text.empty()) return true;
  ERR_clear_error();
  std::size_t written = 0;
  const int result = SSL_write_ex(state_->ssl.get(), text.data(), text.size(), &written);
  if (result == 1) return true;
  (void)status_of(result);
  return false;
}

void TlsChannel::end() {
  ERR_clear_error();
  (void)SSL_shutdown(state_->ssl.get());  // fails during the handshake, where it says nothing
  ERR_clear_error();
}

Bytes& TlsChannel::output() { return state_->output; }
const std::string& TlsChannel::error() const { return state_->error; }

ChannelBinding TlsChannel::binding() const {
  ChannelBinding binding{};
  const int made =
      SSL_export_keying_material(state_->ssl.get(), binding.data(), binding.size(),
                                 kExporterLabel.data(), kExporterLabel.size(), nullptr, 0, 0);
  RUNSTONE_ASSERT(made == 1);
  return binding;
}

}  // namespace runstone
