// ClientFiles: the files of the client for browsers, as the preset web builds them. They are read
// once, when the gateway starts. Their names are fixed, so no path of a request leads to a disk.
// Thread: any, after load().
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// The folder of the client among the paths of the gateway.
inline constexpr std::string_view kClientPath = "/client/";

/// One file in the form that a browser accepts.
struct ClientFile {
  std::string type;      // of its content
  std::string encoding;  // "br", "gzip", or empty: as it is
  std::string tag;       // differs for each content and encoding; as in the header ETag
  std::shared_ptr<const std::string> bytes;
};

class ClientFiles {
 public:
  /// Makes an object without files.
  ClientFiles() = default;
  /// Reads all files of the client, and their compressed forms, if there are any. Fails with one
  /// line if a file is missing.
  static Result<ClientFiles, std::string> load(const std::string& folder);

  bool empty() const { return files_.empty(); }
  /// Returns the file at a path such as "/client/client.js", in the smallest form that the header
  /// Accept-Encoding of a request allows, or null. "/client/" is the page itself.
  const ClientFile* find(std::string_view path, std::string_view accept_encoding) const;

 private:
  struct Forms {
    ClientFile plain, gzip, brotli;  // bytes may be null in the last two
  };
  std::map<std::string, Forms, std::less<>> files_;  // by path
};

/// Returns true if a header Accept-Encoding has this coding, without `q=0`.
bool accepts(std::string_view accept_encoding, std::string_view coding);

}  // namespace runstone
