// Self-signed certificate: an X.509 certificate (RFC 5280) for an Ed25519 key (RFC 8410).
#pragma once
#include <openssl/evp.h>
#include <openssl/x509.h>

#include "common/tls/openssl_ptr.hpp"
#include "common/tls/tls_context.hpp"

namespace runstone {

struct CertificateWithKey {
  OpensslPtr<X509, X509_free> certificate;
  OpensslPtr<EVP_PKEY, EVP_PKEY_free> key;
};

/// Returns the certificate of the seed's key, named "runstone", valid from 2000 on without an end.
/// Equal seeds give equal bytes.
CertificateWithKey self_signed_certificate(Ed25519Seed seed);

}  // namespace runstone
