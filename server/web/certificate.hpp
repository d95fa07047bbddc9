// Certificate: the TLS certificate of a gateway and its files, which may be replaced while it runs.
// Thread: one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/tls/tls_context.hpp"

namespace runstone {

class Certificate {
 public:
  /// Reads the files. Two empty names mean a gateway without TLS. Fails with one line if a file
  /// cannot be used.
  static Result<Certificate, std::string> read(const std::string& chain_file,
                                               const std::string& key_file);

  bool is_there() const { return context_.has_value(); }
  /// Returns what new connections use, or null. Connections that were made with it keep what they
  /// need of it.
  const TlsContext* context() const { return context_ ? &*context_ : nullptr; }
  /// Returns when the certificate ends, in seconds of UTC since 1970; 0 without TLS.
  std::int64_t ends_s() const { return ends_s_; }
  /// Returns a line that says why browsers refuse the certificate today: it has ended, or is not
  /// valid yet. Returns nullopt if it is valid, or without TLS.
  std::optional<std::string> fault() const;

  /// Reads the files again. If the new certificate cannot be used, or has a fault(), the old one
  /// stays, and the error says why. Requires is_there().
  Result<void, std::string> reload();
  /// Returns true if the files have changed since they were read, and then not for two seconds: a
  /// program that replaces them writes one after the other. Call it about once a second.
  bool has_changed(TimeUs now_us);

 private:
  /// Two stamps of a file are equal if neither the file nor its rights changed between them.
  struct Stamp {
    std::uint64_t device = 0, number = 0, bytes = 0;
    std::int64_t changed_s = 0, changed_ns = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Stamps {
    Stamp chain, key;
    friend bool operator==(const Stamps&, const Stamps&) = default;
  };
  static Stamp stamp_of(const std::string& file);
  Stamps stamps() const { return {stamp_of(chain_file_), stamp_of(key_file_)}; }

  std::string chain_file_, key_file_;
  std::optional<TlsContext> context_;  // nullopt: no TLS
  std::int64_t ends_s_ = 0;
  Stamps read_, seen_;  // when the files were read, and at the last call of has_changed()
  TimeUs seen_since_us_ = 0;
};

}  // namespace runstone
