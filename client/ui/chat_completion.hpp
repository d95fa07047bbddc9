// ChatCompletion: completes a line of chat for the tab key, by names of players and words of
// commands of the server. Pressing the key again takes the next word that fits. Pure. One thread.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace runstone {

/// Returns the commands of a server, words with single blanks between, ascending. The server
/// decides which of them a player may give.
std::span<const std::string_view> completed_commands();

class ChatCompletion {
 public:
  /// Sets the names of the players who are here.
  void set_names(std::vector<std::string> names) { names_ = std::move(names); }

  struct Line {
    std::string text;
    std::size_t cursor = 0;  // bytes
    friend bool operator==(const Line&, const Line&) = default;
  };
  /// Completes the word that ends at the cursor, with the first word that fits, or with the next
  /// one if `line` is the result of the call before. Returns the same line if nothing fits. In
  /// commands a name with blanks gets quotes. Cost: O(names + commands).
  Line complete(const Line& line);

 private:
  std::vector<std::string> candidates(std::string_view before) const;

  std::vector<std::string> names_;
  Line given_;                        // the result of the last call
  std::size_t from_ = 0;              // where the completed word begins
  std::string rest_;                  // of the line, behind the word
  std::vector<std::string> fitting_;  // the words that fit
  std::size_t next_ = 0;              // of fitting_
};

}  // namespace runstone
