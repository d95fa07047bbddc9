#include "tests/support/tls/pem_files.hpp"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <fstream>

#include "common/core/assert.hpp"
#include "common/tls/openssl_ptr.hpp"

namespace runstone::test {
namespace {

using Certificate = OpensslPtr<X509, X509_free>;
using Key = OpensslPtr<EVP_PKEY, EVP_PKEY_free>;

Key make_key() { return Key(EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256")); }

void add_extension(X509* certificate, int kind, const std::string& text) {
  const OpensslPtr<X509_EXTENSION, X509_EXTENSION_free> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, text.c_str()));
  RUNSTONE_ASSERT(extension != nullptr);
  RUNSTONE_ASSERT(X509_add_ext(certificate, extension.get(), -1) == 1);
}

Certificate make_certificate(const std::string& name, EVP_PKEY* key, long serial, long begin_s,
                             long end_s) {
  Certificate made(X509_new());
  RUNSTONE_ASSERT(made != nullptr && X509_set_version(made.get(), 2) == 1);
  ASN1_INTEGER_set(X509_get_serialNumber(made.get()), serial);
  X509_gmtime_adj(X509_getm_notBefore(made.get()), begin_s);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), end_s);
  X509_set_pubkey(made.get(), key);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(made.get()), "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  return made;
}

template <class Write>
std::string pem_of(Write write) {
  const OpensslPtr<BIO, BIO_free> out(BIO_new(BIO_s_mem()));
  RUNSTONE_ASSERT(write(out.get()) == 1);
  char* text = nullptr;
  const long bytes = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(bytes)};
}

std::string pem_of(X509* certificate) {
  return pem_of([certificate](BIO* out) { return PEM_write_bio_X509(out, certificate); });
}

void write_file(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  RUNSTONE_ASSERT(::chmod(file.c_str(), S_IRUSR | S_IWUSR) == 0);
}

}  // namespace

PemFiles::PemFiles(const std::string& host, long begin_s, long end_s) {
  const Key authority_key = make_key(), server_key = make_key();
  const Certificate authority =
      make_certificate("authority", authority_key.get(), 1, -kDaySeconds, kDaySeconds);
  X509_set_issuer_name(authority.get(), X509_get_subject_name(authority.get()));
  add_extension(authority.get(), NID_basic_constraints, "critical,CA:TRUE");
  RUNSTONE_ASSERT(X509_sign(authority.get(), authority_key.get(), EVP_sha256()) > 0);
  const Certificate server = make_certificate(host, server_key.get(), 2, begin_s, end_s);
  X509_set_issuer_name(server.get(), X509_get_subject_name(authority.get()));
  add_extension(server.get(), NID_subject_alt_name, "DNS:" + host);
  RUNSTONE_ASSERT(X509_sign(server.get(), authority_key.get(), EVP_sha256()) > 0);
  chain_ = pem_of(server.get()) + pem_of(authority.get());
  key_ = pem_of([&](BIO* out) {
    return PEM_write_bio_PrivateKey(out, server_key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  });
  write_file(authority_file(), pem_of(authority.get()));
  write_file(chain_file(), chain_);
  write_file(key_file(), key_);
}

}  // namespace runstone::test
