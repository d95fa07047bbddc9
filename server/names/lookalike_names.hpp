// LookalikeNames: names that nobody else may seem to have. A name is compared with them as a whole
// and word by word, by how it looks (name_skeleton.hpp): "[ADMIN] ana", "a d m i n" and "mօd" look
// like names of the server.
// Threads: const access from anywhere.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

class LookalikeNames {
 public:
  /// A name that is taken only by a name that looks like it as a whole, because people use the word
  /// within their names ("me", "here").
  enum class Compare { whole, words };

  /// Adds a name. Cost: some microseconds.
  void add(const std::string& name, Compare compare = Compare::words);
  /// Returns the added name that `name` looks like, or nullopt. Several words in a row count as one.
  /// Cost: some microseconds for each word, and O(words^2 log names).
  std::optional<std::string> like(std::string_view name) const;

 private:
  std::map<std::string, std::string> whole_, words_;  // name by skeleton
};

/// Returns true if `name` stands among the names that are compared as a whole: those that mean a
/// listener, and not somebody who speaks.
bool is_compared_whole(std::string_view name);

}  // namespace runstone
