#include "server/runtime/encryption.hpp"

#include <sys/stat.h>

#include "common/os/private_file.hpp"

namespace runstone {
namespace {

Result<std::string, std::string> read_pem(const char* setting, const std::string& file) {
  auto text = read_file(file, kSmallFileBytesMax);
  if (!text) return failure(std::string(setting) + " = " + text.error());
  if (text->empty()) return failure(std::string(setting) + " = " + file + ": is empty");
  return text;
}

bool others_can_read(const std::string& file) {
  struct stat about{};
  return ::stat(file.c_str(), &about) == 0 && (about.st_mode & S_IROTH) != 0;
}

}  // namespace

Result<void, std::string> may_listen_at(const asio::ip::address& address,
                                        const ServerConfig& config) {
  if (!config.insecure || config.i_know || address.is_loopback()) return {};
  return failure("listen = \"" + config.listen +
                 "\": insecure is for this machine only, because everybody on the way could read "
                 "and change what players send: listen on 127.0.0.1, or add --i-know");
}

Result<std::optional<TlsContext>, std::string> configured_certificate(const ServerConfig& config) {
  if (config.tls_certificate.empty() != config.tls_key.empty())
    return failure("tls_certificate and tls_key: one of them is missing");
  if (config.tls_key.empty()) return std::optional<TlsContext>();
  const auto chain = read_pem("tls_certificate", config.tls_certificate);
  if (!chain) return failure(chain.error());
  const auto key = read_pem("tls_key", config.tls_key);
  if (!key) return failure(key.error());
  if (others_can_read(config.tls_key)) {
    return failure("tls_key = \"" + config.tls_key +
                   "\": every user of this machine can read the secret key: chmod o-r it");
  }
  auto context = TlsContext::server(*chain, *key);
  if (!context) {
    return failure("tls_certificate = \"" + config.tls_certificate + "\", tls_key = \"" +
                   config.tls_key + "\": " + context.error());
  }
  return std::optional<TlsContext>(*std::move(context));
}

}  // namespace runstone
