#include "server/web/certificate.hpp"

#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/stat.h>

#include <ctime>
#include <utility>

#include "common/os/private_file.hpp"

namespace runstone {
namespace {

constexpr TimeUs kQuietUs = 2'000'000;

struct ReadCertificate {
  TlsContext context;
  std::int64_t ends_s;
};

std::int64_t end_of(SSL_CTX* context) {
  const X509* const certificate = SSL_CTX_get0_certificate(context);
  tm end{};
  if (certificate == nullptr || ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &end) != 1)
    return 0;
  return ::timegm(&end);
}

/// Returns why browsers refuse a certificate today, or nullopt.
std::optional<std::string> fault_of_time(SSL_CTX* context) {
  const X509* const certificate = SSL_CTX_get0_certificate(context);
  if (end_of(context) < static_cast<std::int64_t>(std::time(nullptr)))
    return "the certificate has ended";
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) >= 0)
    return "the certificate is not valid yet";
  return std::nullopt;
}

Result<ReadCertificate, std::string> read_files(const std::string& chain_file,
                                                const std::string& key_file) {
  struct stat about{};
  if (::stat(key_file.c_str(), &about) == 0 && (about.st_mode & S_IROTH) != 0) {
    return failure("tls_key = \"" + key_file +
                   "\": every user of this machine can read the secret key: chmod o-r it");
  }
  const auto chain = read_file(chain_file, kSmallFileBytesMax);
  if (!chain) return failure("tls_certificate = " + chain.error());
  const auto key = read_file(key_file, kSmallFileBytesMax);
  if (!key) return failure("tls_key = " + key.error());
  auto context = TlsContext::server(*chain, *key);
  if (!context)
    return failure("\"" + chain_file + "\" and \"" + key_file + "\": " + context.error());
  const std::int64_t ends_s = end_of(context->get());
  return ReadCertificate{*std::move(context), ends_s};
}

}  // namespace

Result<Certificate, std::string> Certificate::read(const std::string& chain_file,
                                                   const std::string& key_file) {
  if (chain_file.empty() != key_file.empty())
    return failure("tls_certificate and tls_key: one of them is missing");
  Certificate out;
  if (key_file.empty()) return out;
  out.chain_file_ = chain_file;
  out.key_file_ = key_file;
  out.read_ = out.seen_ = out.stamps();
  auto files = read_files(chain_file, key_file);
  if (!files) return failure(files.error());
  out.context_ = std::move(files->context);
  out.ends_s_ = files->ends_s;
  return out;
}

std::optional<std::string> Certificate::fault() const {
  const auto fault = context_ ? fault_of_time(context_->get()) : std::nullopt;
  if (!fault) return std::nullopt;
  return "tls_certificate = \"" + chain_file_ + "\": " + *fault;
}

Result<void, std::string> Certificate::reload() {
  // Files that change while they are read differ from these stamps and are read once more.
  read_ = stamps();
  auto files = read_files(chain_file_, key_file_);
  if (!files) return failure(files.error());
  if (const auto fault = fault_of_time(files->context.get()))
    return failure("tls_certificate = \"" + chain_file_ + "\": " + *fault);
  context_ = std::move(files->context);
  ends_s_ = files->ends_s;
  return {};
}

bool Certificate::has_changed(TimeUs now_us) {
  if (!is_there()) return false;
  const Stamps now = stamps();
  if (now != seen_) {
    seen_ = now;
    seen_since_us_ = now_us;
  }
  return now != read_ && now_us - seen_since_us_ >= kQuietUs;
}

// The time of the last change of the file or of its rights: both can mend a file that was refused.
Certificate::Stamp Certificate::stamp_of(const std::string& file) {
  struct stat about{};
  if (::stat(file.c_str(), &about) != 0) return {};
  return {static_cast<std::uint64_t>(about.st_dev), static_cast<std::uint64_t>(about.st_ino),
          static_cast<std::uint64_t>(about.st_size), about.st_ctim.tv_sec, about.st_ctim.tv_nsec};
}

}  // namespace runstone
