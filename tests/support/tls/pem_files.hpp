// PemFiles: the certificate of an authority, and a server's certificate that it has signed, as PEM
// text and as files.
#pragma once
#include <string>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

class PemFiles {
 public:
  static constexpr long kDaySeconds = 86'400;

  /// Makes an authority and a server's certificate for this host name. It is valid between these
  /// times, in seconds from now.
  explicit PemFiles(const std::string& host, long begin_s = -kDaySeconds, long end_s = kDaySeconds);

  const std::string& chain() const { return chain_; }
  const std::string& key() const { return key_; }
  std::string authority_file() const { return folder_ / "authority.pem"; }
  std::string chain_file() const { return folder_ / "chain.pem"; }
  std::string key_file() const { return folder_ / "key.pem"; }

 private:
  TempFolder folder_;
  std::string chain_, key_;
};

}  // namespace runstone::test
