// Encryption: what the configuration says of TLS.
#pragma once
#include <asio/ip/address.hpp>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "common/tls/tls_context.hpp"
#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns an error if the connections of a server that listens at this address would not be
/// encrypted although others can listen to them.
Result<void, std::string> may_listen_at(const asio::ip::address& address,
                                        const ServerConfig& config);

/// Reads the certificate and the secret key that the configuration names, if it names any. The
/// error names the setting and the file.
Result<std::optional<TlsContext>, std::string> configured_certificate(const ServerConfig& config);

}  // namespace runstone
