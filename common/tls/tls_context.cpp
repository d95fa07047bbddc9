#include "common/tls/tls_context.hpp"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "common/core/assert.hpp"
#include "common/tls/openssl_error.hpp"
#include "common/tls/openssl_ptr.hpp"
#include "common/tls/record_memory.hpp"
#include "common/tls/self_signed_certificate.hpp"

namespace runstone {
namespace {

using BioPtr = OpensslPtr<BIO, BIO_free>;
using CertificatePtr = OpensslPtr<X509, X509_free>;
using KeyPtr = OpensslPtr<EVP_PKEY, EVP_PKEY_free>;

// AES-128 is the fastest where processors have instructions for it, and ChaCha20 elsewhere.
constexpr const char* kCipherSuites =
    "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256:TLS_AES_256_GCM_SHA384";
constexpr const char* kGroups = "X25519:P-256";

std::shared_ptr<SSL_CTX> make_context(const SSL_METHOD* method) {
  recycle_record_memory();
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(method), SSL_CTX_free);
  RUNSTONE_ASSERT(context != nullptr);
  SSL_CTX* const raw = context.get();
  const bool is_set = SSL_CTX_set_min_proto_version(raw, TLS1_3_VERSION) == 1 &&
                      SSL_CTX_set_ciphersuites(raw, kCipherSuites) == 1 &&
                      SSL_CTX_set1_groups_list(raw, kGroups) == 1 &&
                      SSL_CTX_set_num_tickets(raw, 0) == 1;
  RUNSTONE_ASSERT(is_set);
  SSL_CTX_set_session_cache_mode(raw, SSL_SESS_CACHE_OFF);
  // An idle connection keeps no buffers, and a whole record is read with one system call.
  SSL_CTX_set_mode(raw, SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_read_ahead(raw, 1);
  return context;
}

BioPtr reader_of(const std::string& text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

bool clear_errors() {
  ERR_clear_error();
  return true;
}

/// Uses the certificates of a chain, the server's own first. Returns false if there is none, or one
/// is damaged.
bool use_chain(SSL_CTX* context, const std::string& pem) {
  const BioPtr in = reader_of(pem);
  const CertificatePtr own(PEM_read_bio_X509_AUX(in.get(), nullptr, nullptr, nullptr));
  if (own == nullptr || SSL_CTX_use_certificate(context, own.get()) != 1) return false;
  while (const CertificatePtr next{PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr)}) {
    if (SSL_CTX_add1_chain_cert(context, next.get()) != 1) return false;
  }
  // The end of the text is an error for OpenSSL, too.
  return ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE && clear_errors();
}

/// A key with a passphrase is refused, because a server starts without anybody who types one.
int no_passphrase(char* /*into*/, int /*size*/, int /*is_writing*/, void* /*data*/) { return -1; }

}  // namespace

TlsContext TlsContext::self_signed_server(Ed25519Seed seed) {
  auto context = make_context(TLS_server_method());
  const CertificateWithKey made = self_signed_certificate(seed);
  const bool is_used = SSL_CTX_use_certificate(context.get(), made.certificate.get()) == 1 &&
                       SSL_CTX_use_PrivateKey(context.get(), made.key.get()) == 1;
  RUNSTONE_ASSERT(is_used);
  return TlsContext(std::move(context));
}

Result<TlsContext, std::string> TlsContext::server(const std::string& chain_pem,
                                                   const std::string& key_pem) {
  auto context = make_context(TLS_server_method());
  if (!use_chain(context.get(), chain_pem)) {
    return failure("the certificate: " + take_openssl_error("no certificate in PEM form"));
  }
  const BioPtr in = reader_of(key_pem);
  const KeyPtr key(PEM_read_bio_PrivateKey(in.get(), nullptr, no_passphrase, nullptr));
  if (key == nullptr)
    return failure("the secret key: " + take_openssl_error("no secret key in PEM form"));
  if (SSL_CTX_use_PrivateKey(context.get(), key.get()) != 1 ||
      SSL_CTX_check_private_key(context.get()) != 1) {
    return failure("the secret key is not that of the certificate: " +
                   take_openssl_error("they differ"));
  }
  return TlsContext(std::move(context));
}

TlsContext TlsContext::client() { return TlsContext(make_context(TLS_client_method())); }

Result<TlsContext, std::string> TlsContext::client_of_authorities(const std::string& ca_file) {
  // OpenSSL says only that it found no certificate there.
  if (std::error_code error; std::filesystem::is_directory(ca_file, error))
    return failure("cannot read the authorities of " + ca_file + ": it is a folder");
  auto context = make_context(TLS_client_method());
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  const int loaded = ca_file.empty() ? SSL_CTX_set_default_verify_paths(context.get())
                                     : SSL_CTX_load_verify_file(context.get(), ca_file.c_str());
  if (loaded != 1) {
    return failure("cannot read the authorities of " +
                   (ca_file.empty() ? std::string("the system") : ca_file) + ": " +
                   take_openssl_error("no certificate in PEM form"));
  }
  return TlsContext(std::move(context));
}

}  // namespace runstone
