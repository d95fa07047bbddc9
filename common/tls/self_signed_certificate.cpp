#include "common/tls/self_signed_certificate.hpp"

#include <openssl/asn1.h>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr long kX509Version3 = 2;  // as X.509 counts
// "99991231235959Z" says that the certificate has no end (RFC 5280, 4.1.2.5). A client compares the
// key, not the dates, so a wrong clock locks nobody out.
constexpr const char* kNotBefore = "20000101000000Z";
constexpr const char* kNotAfter = "99991231235959Z";

}  // namespace

CertificateWithKey self_signed_certificate(Ed25519Seed seed) {
  CertificateWithKey made;
  made.key.reset(EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, seed.data(), seed.size()));
  made.certificate.reset(X509_new());
  // Nothing below fails but for want of memory.
  RUNSTONE_ASSERT(made.key != nullptr && made.certificate != nullptr);
  X509* const certificate = made.certificate.get();
  X509_NAME* const name = X509_get_subject_name(certificate);
  const auto* const common_name = reinterpret_cast<const unsigned char*>("runstone");
  const bool is_made =
      X509_set_version(certificate, kX509Version3) == 1 &&
      ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1) == 1 &&
      ASN1_TIME_set_string_X509(X509_getm_notBefore(certificate), kNotBefore) == 1 &&
      ASN1_TIME_set_string_X509(X509_getm_notAfter(certificate), kNotAfter) == 1 &&
      X509_set_pubkey(certificate, made.key.get()) == 1 &&
      X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, common_name, -1, -1, 0) == 1 &&
      X509_set_issuer_name(certificate, name) == 1 &&
      X509_sign(certificate, made.key.get(), nullptr) > 0;  // Ed25519 has no separate hash
  RUNSTONE_ASSERT(is_made);
  return made;
}

}  // namespace runstone
