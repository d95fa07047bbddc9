#include "common/tls/openssl_error.hpp"

#include <openssl/err.h>

namespace runstone {

std::string take_openssl_error(const char* otherwise) {
  const unsigned long error = ERR_get_error();
  ERR_clear_error();
  if (error == 0) return otherwise;
  const char* const reason = ERR_reason_error_string(error);
  return reason == nullptr ? otherwise : reason;
}

}  // namespace runstone
