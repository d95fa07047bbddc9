// TlsContext: what all TLS connections of one side share: the protocol version, the ciphers and, on
// a server, the certificate with its secret key. Only TLS 1.3 (RFC 8446) is spoken, without session
// tickets and without early data, so that no connection depends on an earlier one.
// Threads: a context may be copied and used from any thread; copies share it.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/core/result.hpp"

struct ssl_ctx_st;

namespace runstone {

/// The 32 secret bytes from which an Ed25519 key pair is derived (RFC 8032).
using Ed25519Seed = std::span<const std::uint8_t, 32>;

class TlsContext {
 public:
  /// Makes a server's context with a certificate of its own. The certificate holds the public key
  /// of the seed and is signed with it. It depends on the seed alone and never expires, so it need
  /// not be stored.
  static TlsContext self_signed_server(Ed25519Seed seed);
  /// Makes a server's context from a certificate chain and its secret key, both as PEM text. The
  /// error says what is wrong with which of the two.
  static Result<TlsContext, std::string> server(const std::string& chain_pem,
                                                const std::string& key_pem);
  /// Makes a client's context that accepts every certificate. The caller proves the server's
  /// identity in another way, bound to the connection by TlsChannel::binding().
  static TlsContext client();
  /// Makes a client's context that accepts certificates of the authorities in `ca_file` (PEM), or
  /// of those that the system trusts if it is empty, for the name given to the channel.
  static Result<TlsContext, std::string> client_of_authorities(const std::string& ca_file);

  ssl_ctx_st* get() const { return context_.get(); }

 private:
  explicit TlsContext(std::shared_ptr<ssl_ctx_st> context) : context_(std::move(context)) {}
  std::shared_ptr<ssl_ctx_st> context_;
};

}  // namespace runstone
